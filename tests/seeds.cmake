# Checks that nothing draws random numbers that differ from run to run: no seed from the clock or the system. Called with
# -D SOURCE=<top of the project>.

cmake_policy(VERSION 3.25)
set(unseeded "random_device|srand\\(|time\\((nullptr|NULL|0)\\)|getrandom|/dev/u?random|default_rng\\(\\)|Math\\.random|random\\.seed\\(\\)|import random$")
foreach(part model sim validate tests notebooks-data)
  foreach(kind cpp hpp c h py sh mjs)
    file(GLOB_RECURSE files ${SOURCE}/${part}/*.${kind})
    foreach(file IN LISTS files)
      file(STRINGS ${file} lines REGEX "${unseeded}")
      if(lines)
        message(SEND_ERROR "${file} draws random numbers without a fixed seed: ${lines}")
      endif()
    endforeach()
  endforeach()
endforeach()
