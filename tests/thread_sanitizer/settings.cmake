# ThreadSanitizer cannot see into uninstrumented libraries: oneTBB is replaced by std::thread, and Embree's callbacks are
# ignored.
foreach(header blocked_range enumerable_thread_specific global_control parallel_for parallel_invoke
               parallel_pipeline parallel_reduce task_arena)
  foreach(folder tbb oneapi/tbb)
    file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/thread_sanitizer/${folder}/${header}.h
         CONTENT "#include \"${CMAKE_CURRENT_LIST_DIR}/tbb_on_threads.hpp\"\n")
  endforeach()
endforeach()
target_include_directories(detp_settings BEFORE INTERFACE ${PROJECT_BINARY_DIR}/thread_sanitizer)
target_compile_options(detp_settings INTERFACE -fsanitize-ignorelist=${CMAKE_CURRENT_LIST_DIR}/ignored.txt)
