// Loads of some lanes of a vector, for the instruction set that is being compiled. Include this file after
// hwy/highway.h, inside its loop over targets.
#if defined(ROPEWALK_SOME_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ROPEWALK_SOME_LANES_INL
#undef ROPEWALK_SOME_LANES_INL
#else
#define ROPEWALK_SOME_LANES_INL
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace ropewalk::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Lanes first .. last - 1.
template <class D>
HWY_INLINE hn::Mask<D> some_lanes(D d, int first, int last) {
  return hn::AndNot(hn::FirstN(d, static_cast<std::size_t>(first)), hn::FirstN(d, static_cast<std::size_t>(last)));
}

// Loads entries first .. last - 1 from p; the other lanes are zero and are not read. p need not be aligned.
template <class D>
HWY_INLINE hn::Vec<D> load_some(D d, const double* p, int first, int last) {
#if HWY_TARGET <= HWY_AVX2
  return hn::MaskedLoad(some_lanes(d, first, last), d, p);
#else
  if (first <= 0 && last >= static_cast<int>(hn::Lanes(d))) return hn::LoadU(d, p);
  alignas(64) double some[hn::MaxLanes(d)] = {};
  for (int k = first; k < last; ++k) some[k] = p[k];
  return hn::Load(d, some);
#endif
}

}  // namespace ropewalk::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
