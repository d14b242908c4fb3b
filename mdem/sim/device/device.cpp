#include "sim/device/device.hpp"

#include <stdexcept>

namespace ropewalk {

std::unique_ptr<Device> open_device(const std::string& name, const KernelShape& shape) {
  const std::string prefix = "opencl:";
  if (name == "gpu") return open_opencl("", true, shape);
  if (name == "c++") return open_this_processor(shape);
  if (name.compare(0, prefix.size(), prefix) == 0 && name.size() > prefix.size())
    return open_opencl(name.substr(prefix.size()), false, shape);
  throw std::invalid_argument("no device is named \"" + name + "\"; name gpu, opencl:TEXT or c++");
}

}  // namespace ropewalk
