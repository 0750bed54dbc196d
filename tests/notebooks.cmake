# Executes the notebooks of notebooks-data, and checks that they draw the pictures that notebooks-data/figures has.
# Also makes small tables by the scripts there, and checks that they have the columns of the kept ones.
# Called with -D SOURCE=<top of the project> -D BUILD=<folder for what is drawn> -D DETP=<the command>
# -D LIBRARY=<libdetp.so>.

cmake_policy(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/debian_python.cmake)
need_debian_python(notebook-packages cffi ipykernel matplotlib nbconvert pandas scipy)

set(drawn ${BUILD}/figures)
file(REMOVE_RECURSE ${drawn})
file(MAKE_DIRECTORY ${drawn})
# The Python package, which a notebook uses.
set(package ${BUILD}/notebooks-package)
file(COPY ${SOURCE}/validate/python/detp DESTINATION ${package})
execute_process(COMMAND ${python} ${SOURCE}/validate/python/declarations.py ${SOURCE}/validate/c/detp.h ${package}/detp
                COMMAND_ERROR_IS_FATAL ANY)
# Nothing of the user's: calibration, settings of matplotlib and IPython, HOME, which may not be there.
foreach(name HOME XDG_CACHE_HOME MPLCONFIGDIR IPYTHONDIR JUPYTER_RUNTIME_DIR JUPYTER_CONFIG_DIR)
  set(ENV{${name}} ${BUILD}/notebooks-home)
endforeach()
file(MAKE_DIRECTORY ${BUILD}/notebooks-home)
unset(ENV{MPLBACKEND})
set(ENV{PYTHONPATH} ${package})
set(ENV{DETP_LIBRARY} ${LIBRARY})

file(GLOB notebooks ${SOURCE}/notebooks-data/*.ipynb)
foreach(notebook ${notebooks})
  execute_process(COMMAND ${CMAKE_COMMAND} -E env DETP_FIGURES=${drawn} ${python} -m nbconvert --to notebook --execute --ExecutePreprocessor.startup_timeout=3000 --ExecutePreprocessor.timeout=-1 --stdout ${notebook}
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

# The other studies take minutes, also with --quick.
foreach(script losses maps studies/effects studies/stopping_rules)
  get_filename_component(table ${script} NAME)
  execute_process(COMMAND ${python} ${SOURCE}/notebooks-data/${script}.py ${DETP} --quick
                  RESULT_VARIABLE failed OUTPUT_VARIABLE made ERROR_VARIABLE errors)
  string(REGEX MATCH "^[^\n]*" columns "${made}")
  file(STRINGS ${SOURCE}/notebooks-data/${table}.csv kept LIMIT_COUNT 1)
  string(REGEX MATCHALL "\n" rows "${made}")
  list(LENGTH rows count)
  if(failed OR NOT columns STREQUAL kept OR count LESS 2)
    message(SEND_ERROR "${table}.py --quick made ${count} lines with the columns ${columns}; ${table}.csv has ${kept}\n${errors}")
  endif()
endforeach()
