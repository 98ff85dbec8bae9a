# bodyloom_module(NAME [PUBLIC lib...] [PRIVATE lib...])
#   One folder = one static library bodyloom_NAME with alias bodyloom::NAME, made of every .cc file in the folder.
#   Baseline CPU flags everywhere: Debian's libceres.a is built for SSE2, and mixing in AVX-compiled Eigen code breaks
#   its aligned allocations (docs/concepts.md, "Why no -march=native"). SIMD lives in Eigen-free *_simd.cc files that
#   pick their instruction set at run time.
function(bodyloom_module name)
  cmake_parse_arguments(ARG "" "" "PUBLIC;PRIVATE" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cc ${CMAKE_CURRENT_SOURCE_DIR}/*/*.cc)
  if(sources)
    add_library(bodyloom_${name} STATIC ${sources})
    target_include_directories(bodyloom_${name} PUBLIC
      $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/bodyloom>)
    target_link_libraries(bodyloom_${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
    bodyloom_flags(bodyloom_${name})
  else()
    add_library(bodyloom_${name} INTERFACE)
    target_link_libraries(bodyloom_${name} INTERFACE ${ARG_PUBLIC})
  endif()
  add_library(bodyloom::${name} ALIAS bodyloom_${name})
  set_target_properties(bodyloom_${name} PROPERTIES EXPORT_NAME ${name})
  set_property(GLOBAL APPEND PROPERTY BODYLOOM_MODULES ${name})
endfunction()

# Warnings and sanitizers shared by every target of the project.
function(bodyloom_flags target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wno-unused-parameter
    -Wno-restrict)  # g++ 12 reports std::string concatenation (GCC bug 105651)
  if(BODYLOOM_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(BODYLOOM_SANITIZE)
    target_compile_options(${target} PUBLIC -fsanitize=${BODYLOOM_SANITIZE} -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=${BODYLOOM_SANITIZE})
  endif()
endfunction()
