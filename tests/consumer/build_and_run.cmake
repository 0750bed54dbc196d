# Installs the build tree beside itself, then configures, builds and runs the consumer against what was installed.
# Called with -D BUILD=<build tree> -D SOURCE=<consumer's folder> -D GENERATOR=<generator>.
set(prefix ${BUILD}/consumer/prefix)
file(REMOVE_RECURSE ${BUILD}/consumer)
foreach(step "${CMAKE_COMMAND};--install;${BUILD};--prefix;${prefix}"
             "${CMAKE_COMMAND};-S;${SOURCE};-B;${BUILD}/consumer/build;-G;${GENERATOR};-D;CMAKE_PREFIX_PATH=${prefix};-D;CMAKE_BUILD_TYPE=Release"
             "${CMAKE_COMMAND};--build;${BUILD}/consumer/build"
             "${BUILD}/consumer/build/consumer")
  execute_process(COMMAND ${step} RESULT_VARIABLE failed OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(failed)
    message(FATAL_ERROR "${step}\n${output}")
  endif()
endforeach()
message("${output}")
