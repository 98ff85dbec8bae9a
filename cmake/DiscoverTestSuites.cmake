# bodyloom_discover_suites(TARGET FOLDER): after each build of TARGET, a GoogleTest program, one ctest entry a suite,
# named FOLDER/Suite, that runs all its cases in one process: starting a program with its libraries costs more than most cases
# take, and what a suite computes once for all its cases would be computed for each. Cases whose name begins with "Slow"
# become an entry FOLDER/Suite.Slow with label slow_FOLDER. Each entry leaves GoogleTest's report of its cases in
# test_cases/ of the build folder.
#
# GoogleTest.cmake of CMake 3.25 only knows one entry a case.
function(bodyloom_discover_suites target folder)
  set(seconds 600)
  if(BODYLOOM_SANITIZE)  # a tenth of the speed
    set(seconds 3600)
  endif()
  set(list_file ${CMAKE_CURRENT_BINARY_DIR}/${target}_suites.cmake)
  # Until the program has been built there is nothing to list: an entry that fails says so.
  file(GENERATE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/${target}_include.cmake CONTENT
       "if(EXISTS \"${list_file}\")\n  include(\"${list_file}\")\nelse()\n  add_test(${folder}/NOT_BUILT ${target})\nendif()\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${CMAKE_CURRENT_BINARY_DIR}/${target}_include.cmake)
  add_custom_command(TARGET ${target} POST_BUILD BYPRODUCTS ${list_file} VERBATIM
    COMMAND ${CMAKE_COMMAND} -D PROGRAM=$<TARGET_FILE:${target}> -D FOLDER=${folder} -D LIST_FILE=${list_file}
            -D REPORTS=${PROJECT_BINARY_DIR}/test_cases -D WORK=${CMAKE_CURRENT_BINARY_DIR}
            -D SECONDS=${seconds}
            -P ${PROJECT_SOURCE_DIR}/cmake/list_test_suites.cmake)
endfunction()
