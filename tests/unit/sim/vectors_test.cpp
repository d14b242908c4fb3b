// Operations of every instruction set against loops over the lanes.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "sim/threads/vector_unit.hpp"

#undef VEC_SOURCE
#define VEC_SOURCE "unit/sim/vectors_test.cpp"
#include "sim/vectors/each_set-inl.hpp"
//
#include "sim/vectors/operations-inl.hpp"

VEC_BEFORE_NAMESPACE();
namespace ropewalk::VEC_SET {
namespace ops = vec::VEC_SET;

template <class T, std::size_t most>
std::vector<T> sums(const T* x) {
  const ops::CappedTag<T, most> d;
  const auto a = ops::Load(d, x), b = ops::Load(d, x + ops::Lanes(d));
  const auto [of_a, of_b] = ops::SumsOfLanes(a, b);
  return {static_cast<T>(ops::Lanes(d)), of_a, of_b, ops::SumOfLanes(a)};
}
std::vector<float> FloatSums(const float* x) { return sums<float, 16>(x); }
std::vector<double> DoubleSums(const double* x) { return sums<double, 8>(x); }

template <class T>
std::uint64_t first(int n) {
  const ops::ScalableTag<T> d;
  return ops::bits_of_mask(d, ops::FirstN(d, n));
}
std::vector<std::uint64_t> First(int n) { return {first<float>(n), first<double>(n)}; }

}  // namespace ropewalk::VEC_SET
VEC_AFTER_NAMESPACE();

#if VEC_ONCE
namespace ropewalk {

VEC_EXPORT(FloatSums);
VEC_EXPORT(DoubleSums);
VEC_EXPORT(First);

namespace {
namespace UNIT {

// The upper half of the lanes that are left is added to the lower half.
template <class T>
T halved(const T* x, std::size_t lanes) {
  std::vector<T> part(x, x + lanes);
  for (std::size_t half = lanes / 2; half > 0; half /= 2)
    for (std::size_t k = 0; k < half; ++k) part[k] += part[k + half];
  return part[0];
}

template <class T>
void expect_sums(std::vector<T> (*of)(const T*)) {
  T x[32];
  for (int k = 0; k < 32; ++k) x[k] = T{1} / static_cast<T>(3 + k * k);
  const std::vector<T> found = of(x);
  const auto lanes = static_cast<std::size_t>(found[0]);
  EXPECT_EQ(found[1], halved(x, lanes));
  EXPECT_EQ(found[2], halved(x + lanes, lanes));
  EXPECT_EQ(found[3], found[1]);
}

TEST(Vectors, SumsOverLanesAreThoseOfHalves) {
  for (const std::string& name : instruction_sets()) {
    SCOPED_TRACE(name);
    ASSERT_TRUE(use_instructions(name));
    expect_sums(&VEC_IN_USE(FloatSums));
    expect_sums(&VEC_IN_USE(DoubleSums));
  }
  use_instructions("");
}

TEST(Vectors, FirstLanesOfAnyNumber) {
  for (const std::string& name : instruction_sets()) {
    SCOPED_TRACE(name);
    ASSERT_TRUE(use_instructions(name));
    const std::vector<std::uint64_t> all = VEC_IN_USE(First)(64);
    EXPECT_EQ(all[0], all[1] * (all[1] + 2));  // twice as many
    for (const int n : {-3, 0, 1, 2, 3, 5, 8, 11, 16, 17, 32, 64, 255, 256, 257, 70000}) {
      const std::uint64_t bits = n > 63 ? ~std::uint64_t{0} : (std::uint64_t{1} << std::max(n, 0)) - 1;
      EXPECT_EQ(VEC_IN_USE(First)(n), (std::vector<std::uint64_t>{bits & all[0], bits & all[1]})) << n;
    }
  }
  use_instructions("");
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
#endif  // VEC_ONCE
