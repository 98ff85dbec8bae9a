# How the project is compiled: build type, compiler cache, and how many heavy files are compiled at once.

# Without a build type CMake compiles with no optimisation at all, some 30 times slower than Release here.
if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Debug, Release, RelWithDebInfo or MinSizeRel" FORCE)
endif()

if(BODYLOOM_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  find_program(BODYLOOM_CCACHE_PROGRAM ccache)
  mark_as_advanced(BODYLOOM_CCACHE_PROGRAM)
  if(BODYLOOM_CCACHE_PROGRAM)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${BODYLOOM_CCACHE_PROGRAM})
  endif()
endif()

# A file that includes torch/torch.h takes about 1.2 GB to compile: as many at once as the memory holds (Ninja only).
cmake_host_system_information(RESULT bodyloom_memory_mb QUERY AVAILABLE_PHYSICAL_MEMORY)
cmake_host_system_information(RESULT bodyloom_cores QUERY NUMBER_OF_LOGICAL_CORES)
math(EXPR bodyloom_torch_jobs "${bodyloom_memory_mb} / 1500")
if(bodyloom_torch_jobs GREATER bodyloom_cores)
  set(bodyloom_torch_jobs ${bodyloom_cores})
elseif(bodyloom_torch_jobs LESS 1)
  set(bodyloom_torch_jobs 1)
endif()
set_property(GLOBAL APPEND PROPERTY JOB_POOLS bodyloom_torch=${bodyloom_torch_jobs})
