# Counts the instructions of line_field by hand and by way of a job: they may differ by 0.5 %. Called with
# -D PROGRAM=<line_field>. Reported as skipped where valgrind is not installed.
cmake_policy(VERSION 3.25)
find_program(VALGRIND valgrind)
if(NOT VALGRIND)
  message("skipped: valgrind is not installed")
  return()
endif()

function(count way)
  # Without what happens before main: how long libraries take to start differs from run to run.
  execute_process(COMMAND ${VALGRIND} --tool=callgrind --toggle-collect=main --callgrind-out-file=/dev/null ${PROGRAM} ${way}
                  OUTPUT_VARIABLE hits ERROR_VARIABLE log RESULT_VARIABLE code)
  if(NOT code EQUAL 0 OR NOT log MATCHES "Collected : ([0-9]+)")
    message(FATAL_ERROR "${way}: ${log}")
  endif()
  set(hits_${way} ${hits} PARENT_SCOPE)
  set(instructions_${way} ${CMAKE_MATCH_1} PARENT_SCOPE)
endfunction()

count(hand)
count(job)
message("instructions by hand ${instructions_hand}, of a job ${instructions_job}")
if(NOT hits_hand STREQUAL hits_job)
  message(FATAL_ERROR "hits differ: ${hits_hand}, ${hits_job}")
endif()
math(EXPR most "${instructions_hand} / 1000 * 1005")
if(instructions_job GREATER most)
  message(FATAL_ERROR "a job without effects takes over 0.5 % more instructions than a search written by hand")
endif()
