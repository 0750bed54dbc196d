# Builds the site, which ends with an error for links that lead nowhere, and runs the commands of its own pages and of README.md. Called with -D SOURCE=<project>,
# -D BUILD=<build tree>.
cmake_policy(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/debian_python.cmake)
need_debian_python(site-packages cffi furo myst_parser numpy sphinx)
find_program(doxygen doxygen)
find_program(povray povray)
if(NOT doxygen OR NOT povray)
  message("skipped: Debian's packages of .ci/site-packages.txt are not installed")
  return()
endif()
execute_process(COMMAND ${python} ${SOURCE}/validate/site/build.py ${BUILD} COMMAND_ERROR_IS_FATAL ANY)
file(GLOB pages ${SOURCE}/validate/site/*.md ${SOURCE}/validate/site/tutorials/*.md ${SOURCE}/validate/site/examples/*.md)
execute_process(COMMAND ${python} ${CMAKE_CURRENT_LIST_DIR}/site_commands.py ${BUILD} ${SOURCE}/README.md ${pages} COMMAND_ERROR_IS_FATAL ANY)
