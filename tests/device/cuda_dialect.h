// Defines the macros of mdem/model/dialect.h and mdem/sim/device/dialect.h for CUDA, so that nvcc can compile the kernels and report the registers of
// each kernel.
#define KERNEL extern "C" __global__ void __launch_bounds__(128)
#define OF_GROUP
#define GLOBAL
#define LOCAL __shared__
#define TO_LOCAL
#define BARRIER __syncthreads()
#define FOR_ITEMS(t) for (int t = threadIdx.x, once = 1; once; once = 0)
#define GROUP_NUMBER ((int)blockIdx.x)
#define BITS_OF(x) __float_as_int(x)
#define FLOAT_OF(i) __int_as_float(i)
#define FMA(a, b, c) fmaf(a, b, c)
#define SQRT_FLOAT(x) sqrtf(x)
#define WHOLE(x) ((int)(unsigned)(long long)rint(x))
#define FLOOR(x) floor(x)
#define ATOMIC_INCREMENT(x) atomicAdd(x, 1)
#define FUNCTION __device__ __forceinline__
#define DEFAULT_0
