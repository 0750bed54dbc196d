# Debian's Python, which its packages are for. need_debian_python(list modules…): ends the script, as a skipped test, if it lacks one of the modules; sets
# `python`. setuptools must come first.
macro(need_debian_python list)
  find_program(python python3 PATHS /usr/bin NO_DEFAULT_PATH)
  string(REPLACE ";" ", " modules "${ARGN}")
  if(python)
    execute_process(COMMAND ${python} -c "import ${modules}" RESULT_VARIABLE missing OUTPUT_QUIET ERROR_QUIET)
  endif()
  if(NOT python OR missing)
    message("skipped: Debian's packages of .ci/${list}.txt are not installed")
    return()
  endif()
endmacro()
