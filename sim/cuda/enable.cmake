# Decides whether the CUDA backend is built: sets SLOSH_HAS_CUDA. Included from the top, because a language that is
# enabled in a folder is known only there.
set(SLOSH_CUDA "AUTO" CACHE STRING "The CUDA backend: AUTO (where a CUDA compiler works), ON or OFF")
set_property(CACHE SLOSH_CUDA PROPERTY STRINGS AUTO ON OFF)
set(SLOSH_HAS_CUDA OFF)

# Leaves the reason in slosh_why when CUDA is not to be had.
macro(slosh_look_for_cuda)
  set(slosh_why "")
  include(CheckLanguage)
  if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES)
    set(CMAKE_CUDA_ARCHITECTURES 90 CACHE STRING "GPU generations to build for (\"native\" on a machine with a GPU)")
  endif()
  check_language(CUDA)
  if(NOT CMAKE_CUDA_COMPILER)
    set(slosh_why "no CUDA compiler that works")
  else()
    enable_language(CUDA)
    if(NOT CMAKE_CUDA20_STANDARD_COMPILE_OPTION) # CMake 3.25 does not know that nvcc 13 speaks C++20
      set(CMAKE_CUDA20_STANDARD_COMPILE_OPTION "-std=c++20")
      set(CMAKE_CUDA20_EXTENSION_COMPILE_OPTION "-std=c++20")
    endif()
    find_package(CUDAToolkit QUIET)
    # A compiler may be there without its headers, or too old for C++20.
    file(WRITE ${CMAKE_BINARY_DIR}/cuda_works.cu
      "#include <cuda_runtime.h>\n#include <concepts>\n"
      "template <std::floating_point T> __global__ void twice(T* x) { *x *= T(2); }\n"
      "int main() { twice<float><<<1, 1>>>(nullptr); return 0; }\n")
    # The source's own standard: 3.25 refuses CUDA_STANDARD 20 before the two lines above can tell it.
    if(NOT DEFINED SLOSH_CUDA_WORKS)
      execute_process(
        COMMAND ${CMAKE_CUDA_COMPILER} -std=c++20 -c cuda_works.cu -o cuda_works.o
        WORKING_DIRECTORY ${CMAKE_BINARY_DIR} RESULT_VARIABLE slosh_nvcc OUTPUT_QUIET ERROR_QUIET)
      if(slosh_nvcc EQUAL 0)
        set(SLOSH_CUDA_WORKS ON CACHE INTERNAL "")
      else()
        set(SLOSH_CUDA_WORKS OFF) # not cached: who mends it configures again
      endif()
    endif()
    if(NOT SLOSH_CUDA_WORKS)
      set(slosh_why "the CUDA compiler cannot build C++20")
    elseif(NOT TARGET CUDA::cudart_static)
      set(slosh_why "the CUDA runtime library is missing")
    endif()
  endif()
endmacro()

if(SLOSH_CUDA STREQUAL "OFF")
  message(STATUS "CUDA backend: off")
elseif(SLOSH_SANITIZE AND SLOSH_CUDA STREQUAL "AUTO")
  message(STATUS "CUDA backend: left out under sanitizers")
else()
  slosh_look_for_cuda()
  if(NOT slosh_why)
    set(SLOSH_HAS_CUDA ON)
    message(STATUS "CUDA backend: ${CMAKE_CUDA_COMPILER_VERSION}, architectures ${CMAKE_CUDA_ARCHITECTURES}")
  elseif(SLOSH_CUDA STREQUAL "ON")
    message(FATAL_ERROR "SLOSH_CUDA is ON: ${slosh_why}. Install the CUDA toolkit, or configure with -DSLOSH_CUDA=AUTO")
  else()
    message(STATUS "CUDA backend: left out, ${slosh_why}")
  endif()
endif()
