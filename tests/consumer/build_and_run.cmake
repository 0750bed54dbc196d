# Installs the build tree, then builds and runs programs against what was installed: a renderer's loop (by find_package
# and by pkg-config), and a program that uses only the formulas (without the packages that the other parts need). Called
# with -D BUILD=<build tree> -D SOURCE=<consumer's folder> -D GENERATOR=<generator> -D COMPILER=<C++ compiler>.
set(prefix ${BUILD}/consumer/prefix)
file(REMOVE_RECURSE ${BUILD}/consumer)

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE failed OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(failed)
    message(FATAL_ERROR "${ARGN}\n${output}")
  endif()
  message("${output}")
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
foreach(formulas_only OFF ON)
  set(tree ${BUILD}/consumer/formulas-only-${formulas_only})
  run(${CMAKE_COMMAND} -S ${SOURCE} -B ${tree} -G ${GENERATOR} -D CMAKE_PREFIX_PATH=${prefix} -D CMAKE_BUILD_TYPE=Release
      -D CMAKE_CXX_COMPILER=${COMPILER} -D FORMULAS_ONLY=${formulas_only} -D DETP_HEADERS=${prefix}/include)
  run(${CMAKE_COMMAND} --build ${tree})
  run(${tree}/consumer)
endforeach()

# The formulas alone are built without the packages that the other parts need.
set(disabled)
foreach(package embree glm hwy TBB nlohmann_json Eigen3 nanoflann CLI11 doctest)
  list(APPEND disabled -D CMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
endforeach()
set(tree ${BUILD}/consumer/only-model)
run(${CMAKE_COMMAND} -S ${SOURCE}/../.. -B ${tree} -G ${GENERATOR} -D CMAKE_BUILD_TYPE=Release -D CMAKE_UNITY_BUILD=ON
    -D CMAKE_CXX_COMPILER=${COMPILER} -D DETP_ONLY_MODEL=ON ${disabled})
run(${CMAKE_COMMAND} --build ${tree})
run(${CMAKE_COMMAND} --install ${tree} --prefix ${tree}/prefix)
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${tree}/formulas -G ${GENERATOR} -D CMAKE_PREFIX_PATH=${tree}/prefix
    -D CMAKE_BUILD_TYPE=Release -D CMAKE_CXX_COMPILER=${COMPILER} -D FORMULAS_ONLY=ON -D DETP_HEADERS=${tree}/prefix/include)
run(${CMAKE_COMMAND} --build ${tree}/formulas)
run(${tree}/formulas/consumer)

find_program(PKG_CONFIG pkg-config REQUIRED)
file(GLOB_RECURSE packages ${prefix}/detp.pc)
get_filename_component(folder ${packages} DIRECTORY)
set(ENV{PKG_CONFIG_PATH} ${folder})
execute_process(COMMAND ${PKG_CONFIG} --cflags --libs detp OUTPUT_VARIABLE flags COMMAND_ERROR_IS_FATAL ANY
                OUTPUT_STRIP_TRAILING_WHITESPACE)
separate_arguments(flags UNIX_COMMAND "${flags}")
run(${COMPILER} -std=c++20 ${SOURCE}/renderer_loop.cpp -o ${BUILD}/consumer/by-pkg-config ${flags})
run(${BUILD}/consumer/by-pkg-config)
