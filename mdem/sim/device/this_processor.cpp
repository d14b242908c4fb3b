// The kernels on the processor of the program: the reading that every device is held to, bit by bit.
#include <omp.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "model/bond.hpp"
#include "model/contract.hpp"
#include "model/dialect.h"
#include "sim/device/device.hpp"
#include "sim/device/dialect.h"
#include "sim/threads/for_each.hpp"
#include "sim/threads/vector_unit.hpp"

namespace ropewalk {
#include "sim/device/types.h"
namespace {

struct alignas(16) int4 {
  int x, y, z, w;
};
struct alignas(16) float4 {
  float x, y, z, w;
};

int bits_of(float x) {
  int bits;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}
float float_of(int bits) {
  float x;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}
// What does not fit, as of a place that is not finite, may be anything.
int whole(double x) {
  constexpr double most = 0x1p62;
  const double rounded = std::rint(x);
  return rounded > -most && rounded < most
             ? static_cast<int>(static_cast<unsigned>(static_cast<std::int64_t>(rounded)))
             : 0;
}

struct HostKernel {
  const char* name;
  int arguments;
  void (*run)(int group, const void* const* values);
};

// Known to a device's compiler, here at run time.
int nodes_of_kernels = 1, types_of_kernels = 1;

}  // namespace
}  // namespace ropewalk

#define NODES nodes_of_kernels
#define TYPES types_of_kernels
#define LOCAL_TYPES MAX_TYPES
#define ROPEWALK_LOOPS "sim/device/kernel_loops-inl.hpp"
#include "sim/threads/for_each_vector_unit-inl.hpp"

namespace ropewalk {
namespace {

class ThisProcessor : public Device {
 public:
  explicit ThisProcessor(const KernelShape& shape) : shape_(shape) {}

  std::string name() const override { return "this processor, by the kernels of a device"; }
  Memory allocate(std::size_t bytes) override {
    const std::size_t of_16 = bytes / 16 + 1;
    return {new int4[of_16], [](void* p) { delete[] static_cast<int4*>(p); }};
  }
  void write(const Memory& to, const void* from, std::size_t bytes) override {
    if (bytes > 0) std::memcpy(to.get(), from, bytes);
  }
  void write_later(const Memory& to, const void* from, std::size_t bytes) override { write(to, from, bytes); }
  void read(const Memory& from, void* to, std::size_t bytes) override {
    if (bytes > 0) std::memcpy(to, from.get(), bytes);
  }

 protected:
  void launch(const char* name, int groups, const Argument* arguments, int count) override {
    const HostKernel* const kernel = ROPEWALK_IN_USE(find_kernel)(name);
    ROPEWALK_EXPECTS(kernel != nullptr && kernel->arguments == count);
    const void* values[32];
    ROPEWALK_EXPECTS(count <= 32);
    for (int k = 0; k < count; ++k) values[k] = arguments[k].at;
    nodes_of_kernels = shape_.nodes, types_of_kernels = shape_.types;
    for_each(groups, groups > 4, [&](int group) { kernel->run(group, values); });
  }

 private:
  KernelShape shape_;
};

}  // namespace

std::unique_ptr<Device> open_this_processor(const KernelShape& shape) {
  ROPEWALK_EXPECTS(shape.nodes <= MAX_NODES && shape.types <= MAX_TYPES);
  return std::make_unique<ThisProcessor>(shape);
}

}  // namespace ropewalk
