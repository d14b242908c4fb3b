// HWY_TARGET_TOGGLE changes from one instruction set to the next: parts that every set needs are included again.
#undef HWY_TARGET
#ifdef HWY_TARGET_TOGGLE
#undef HWY_TARGET_TOGGLE
#else
#define HWY_TARGET_TOGGLE
#endif
