// VEC_TOGGLE changes from one instruction set to the next: parts that every set needs are included again.
#undef VEC_TARGET
#ifdef VEC_TOGGLE
#undef VEC_TOGGLE
#else
#define VEC_TOGGLE
#endif
