// Loads of some lanes of a vector, for the instruction set that is being compiled. Include this file after
// sim/vectors/operations-inl.hpp, inside its loop over targets.
#if defined(ROPEWALK_SOME_LANES_INL) == defined(VEC_TOGGLE)
#ifdef ROPEWALK_SOME_LANES_INL
#undef ROPEWALK_SOME_LANES_INL
#else
#define ROPEWALK_SOME_LANES_INL
#endif

#include "sim/vectors/operations-inl.hpp"

VEC_BEFORE_NAMESPACE();
namespace ropewalk::VEC_SET {
namespace ops = vec::VEC_SET;

// Lanes first .. last - 1.
template <class D>
VEC_INLINE ops::Mask<D> some_lanes(D d, int first, int last) {
  return ops::AndNot(ops::FirstN(d, first), ops::FirstN(d, last));
}

// Loads entries first .. last - 1 from p; the other lanes are zero and are not read. p need not be aligned.
template <class D>
VEC_INLINE ops::Vec<D> load_some(D d, const double* p, int first, int last) {
#if VEC_TARGET <= VEC_AVX2
  return ops::MaskedLoad(some_lanes(d, first, last), d, p);
#else
  if (first <= 0 && last >= static_cast<int>(ops::Lanes(d))) return ops::Load(d, p);
  alignas(64) double some[ops::Lanes(d)] = {};
  for (int k = first; k < last; ++k) some[k] = p[k];
  return ops::Load(d, some);
#endif
}

}  // namespace ropewalk::VEC_SET
VEC_AFTER_NAMESPACE();

#endif
