// The kernels of a device as C++. Compiled for each vector unit, see sim/threads/vector_unit.hpp.
namespace ropewalk {
namespace ROPEWALK_UNIT {
namespace {

using namespace forms;
#include "sim/device/kernels.h"

// Calls a kernel with the values that `arguments` point to.
template <class... A, std::size_t... k>
void call(void (*kernel)(int, A...), int group, const void* const* arguments, std::index_sequence<k...>) {
  kernel(group, *static_cast<const A*>(arguments[k])...);
}
template <auto kernel>
struct Called;
template <class... A, void (*kernel)(int, A...)>
struct Called<kernel> {
  static constexpr int arguments = sizeof...(A);
  static void run(int group, const void* const* values) {
    call(kernel, group, values, std::index_sequence_for<A...>());
  }
};

template <auto kernel>
constexpr HostKernel host_kernel(const char* name) {
  return {name, Called<kernel>::arguments, Called<kernel>::run};
}

constexpr HostKernel all_kernels[] = {host_kernel<kick>("kick"),
                                      host_kernel<put_motion>("put_motion"),
                                      host_kernel<drift>("drift"),
                                      host_kernel<line_contact>("line_contact"),
                                      host_kernel<viscosity>("viscosity"),
                                      host_kernel<bonds>("bonds"),
                                      host_kernel<count_cells>("count_cells"),
                                      host_kernel<fill_cells>("fill_cells"),
                                      host_kernel<find_neighbours>("find_neighbours"),
                                      host_kernel<collect>("collect"),
                                      host_kernel<summary>("summary"),
                                      host_kernel<get_force>("get_force")};

const HostKernel* find_kernel(const char* name) {
  for (const HostKernel& kernel : all_kernels)
    if (std::strcmp(kernel.name, name) == 0) return &kernel;
  return nullptr;
}

}  // namespace
}  // namespace ROPEWALK_UNIT
}  // namespace ropewalk
