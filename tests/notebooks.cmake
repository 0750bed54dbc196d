# Executes the notebooks of notebooks-data, and checks that they draw the pictures that notebooks-data/figures has.
# Called with -D SOURCE=<top of the project> -D BUILD=<folder for what is drawn>.

cmake_policy(VERSION 3.25)
find_program(python python3 PATHS /usr/bin NO_DEFAULT_PATH)  # Debian's, which its packages are for
if(python)
  execute_process(COMMAND ${python} -c "import ipykernel, matplotlib, nbconvert, pandas" RESULT_VARIABLE missing OUTPUT_QUIET ERROR_QUIET)
endif()
if(NOT python OR missing)
  message("skipped: Debian's packages of .ci/notebook-packages.txt are not installed")
  return()
endif()

set(drawn ${BUILD}/figures)
file(REMOVE_RECURSE ${drawn})
file(MAKE_DIRECTORY ${drawn})
file(GLOB notebooks ${SOURCE}/notebooks-data/*.ipynb)
foreach(notebook ${notebooks})
  execute_process(COMMAND ${CMAKE_COMMAND} -E env DETP_FIGURES=${drawn} ${python} -m nbconvert --to notebook --execute --stdout ${notebook}
                  WORKING_DIRECTORY ${SOURCE}/notebooks-data RESULT_VARIABLE failed OUTPUT_QUIET ERROR_VARIABLE errors)
  if(failed)
    message(SEND_ERROR "${notebook}:\n${errors}")
  endif()
endforeach()

execute_process(COMMAND ${python} ${CMAKE_CURRENT_LIST_DIR}/same_pictures.py ${SOURCE}/notebooks-data/figures ${drawn}
                RESULT_VARIABLE failed ERROR_VARIABLE errors)
if(failed)
  message(SEND_ERROR "${errors}")
endif()
