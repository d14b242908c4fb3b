// Macros in which kernels.h is written, beside those of model/dialect.h: once for OpenCL C, once for C++.
//
// A kernel runs once for every group of GROUP work items, in phases: FOR_ITEMS(t) { ... } is one phase, run by every
// item t of the group, and BARRIER stands between two phases. What a phase leaves to the next lies in LOCAL arrays. In
// C++ a phase is a loop over the items.
//
// Floats: + - * fma are the same on every device (IEEE 754); products are fused with sums where FMA says so and nowhere
// else. / and sqrt of floats, and floats below 1e-38, are the same where the device says so.
#if defined(__OPENCL_VERSION__) || defined(__OPENCL_C_VERSION__)
#define KERNEL __kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void
#define OF_GROUP
#define LOCAL __local
#define TO_LOCAL __local  // address space of a pointer
#define BARRIER barrier(CLK_LOCAL_MEM_FENCE)
#define FOR_ITEMS(t) for (int t = get_local_id(0), once = 1; once; once = 0)
#define GROUP_NUMBER ((int)get_group_id(0))
#define BITS_OF(x) as_int(x)
#define FLOAT_OF(i) as_float(i)
#define FMA(a, b, c) fma(a, b, c)
#define SQRT_FLOAT(x) sqrt(x)
#define WHOLE(x) ((int)(uint)(long)rint(x))
#define FLOOR(x) floor(x)
#define ATOMIC_INCREMENT(x) atomic_inc(x)
#else
#define KERNEL void
#define OF_GROUP int GROUP_NUMBER,  // first argument of a kernel
#define LOCAL
#define TO_LOCAL
#define BARRIER
#define FOR_ITEMS(t) for (int t = 0; t < GROUP; ++t)
#define BITS_OF(x) bits_of(x)
#define FLOAT_OF(i) float_of(i)
#define FMA(a, b, c) __builtin_fmaf(a, b, c)
#define SQRT_FLOAT(x) __builtin_sqrtf(x)
#define WHOLE(x) whole(x)
#define FLOOR(x) __builtin_floor(x)
#define ATOMIC_INCREMENT(x) __atomic_fetch_add(x, 1, __ATOMIC_RELAXED)
#endif
