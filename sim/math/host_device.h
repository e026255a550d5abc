// Marks functions that the CPU and the CUDA compiler both build.
#pragma once

#ifdef __CUDACC__
#define SLOSH_HD __host__ __device__
#else
#define SLOSH_HD
#endif
