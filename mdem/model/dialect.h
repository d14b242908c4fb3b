// Words in which forms.h is written, so that OpenCL C 1.2, CUDA and C++ read one text. The kernels of a device
// (sim/device/kernels.h) are written in them too.
//
// + - * / sqrt of doubles are the same on every device (IEEE 754). The forms call no exp, log or atan2, whose last bits
// differ. In OpenCL each operation is rounded by itself; a C++ file chooses by its options.
//
// OpenCL C has no overloads, references or initial values of members, and reserves names: half, dot, cross, ...
#if defined(__OPENCL_VERSION__) || defined(__OPENCL_C_VERSION__)
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#pragma OPENCL FP_CONTRACT OFF
#define FUNCTION
#define GLOBAL __global
#define DEFAULT_0
#else
// Always inlined: the loops for each vector unit (sim/threads/vector_unit.hpp) get the form in their own instructions.
#define FUNCTION inline __attribute__((always_inline))
#define GLOBAL
#define DEFAULT_0 = {}  // initial value of a member
#endif
