# Builds the site, which ends with an error for links that lead nowhere, and runs the commands of its own pages. Called with -D SOURCE=<project>,
# -D BUILD=<build tree>.
cmake_policy(VERSION 3.25)
find_program(python python3 PATHS /usr/bin NO_DEFAULT_PATH)  # Debian's, which its packages are for
find_program(doxygen doxygen)
if(python)
  execute_process(COMMAND ${python} -c "import cffi, furo, myst_parser, numpy, sphinx" RESULT_VARIABLE missing OUTPUT_QUIET ERROR_QUIET)
endif()
if(NOT python OR missing OR NOT doxygen)
  message("skipped: Debian's packages of .ci/site-packages.txt are not installed")
  return()
endif()
execute_process(COMMAND ${python} ${SOURCE}/validate/site/build.py ${BUILD} COMMAND_ERROR_IS_FATAL ANY)
file(GLOB pages ${SOURCE}/validate/site/*.md ${SOURCE}/validate/site/tutorials/*.md)
execute_process(COMMAND ${python} ${CMAKE_CURRENT_LIST_DIR}/site_commands.py ${BUILD} ${pages} COMMAND_ERROR_IS_FATAL ANY)
