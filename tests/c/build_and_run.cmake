# Installs the build tree, moves it, and builds the C example against it by both compilers and by CMake; compares what the shared library
# exports with symbols.txt. Called with -D BUILD=<build tree> -D SOURCE=<this folder> -D GENERATOR=<generator>.
set(place ${BUILD}/c-interface)
file(REMOVE_RECURSE ${place})

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE failed OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(failed)
    message(FATAL_ERROR "${ARGN}\n${output}")
  endif()
  message("${output}")
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${place}/first)
file(RENAME ${place}/first ${place}/moved)
file(GLOB_RECURSE library ${place}/moved/libdetp.so)
file(GLOB_RECURSE package ${place}/moved/detp-c.pc)
get_filename_component(folder ${library} DIRECTORY)
get_filename_component(package_folder ${package} DIRECTORY)

execute_process(COMMAND nm -D --defined-only ${library} OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "detp_[a-z_]+" symbols "${symbols}")
list(SORT symbols)
file(STRINGS ${SOURCE}/symbols.txt kept)
if(NOT symbols STREQUAL kept)
  message(SEND_ERROR "the library exports ${symbols}\nsymbols.txt has ${kept}")
endif()

# A program may close the library while threads of oneTBB still run.
execute_process(COMMAND readelf -d ${library} OUTPUT_VARIABLE flags COMMAND_ERROR_IS_FATAL ANY)
if(NOT flags MATCHES "NODELETE")
  message(SEND_ERROR "the library would be unloaded")
endif()

find_program(PKG_CONFIG pkg-config REQUIRED)
set(ENV{PKG_CONFIG_PATH} ${package_folder})
execute_process(COMMAND ${PKG_CONFIG} --cflags --libs detp-c OUTPUT_VARIABLE flags COMMAND_ERROR_IS_FATAL ANY
                OUTPUT_STRIP_TRAILING_WHITESPACE)
separate_arguments(flags UNIX_COMMAND "${flags}")
foreach(compiler gcc clang-14)
  find_program(${compiler}_program ${compiler})
  if(NOT ${compiler}_program)
    message("skipped: ${compiler} is not installed")
    continue()
  endif()
  run(${${compiler}_program} -std=c99 -O2 -Wall -Wextra -Wpedantic -Werror ${SOURCE}/example.c -o ${place}/by-${compiler} ${flags})
  run(${place}/by-${compiler})
endforeach()

run(${CMAKE_COMMAND} -S ${SOURCE} -B ${place}/by-cmake -G ${GENERATOR} -D CMAKE_PREFIX_PATH=${place}/moved)
run(${CMAKE_COMMAND} --build ${place}/by-cmake)
run(${place}/by-cmake/example)
