#include "run/use_device.hpp"

#include <exception>

#include "model/error.hpp"

namespace ropewalk {

void use_device(Simulation& simulation, const std::string& name) {
  try {
    simulation.use_device(name);
  } catch (const std::exception& e) {
    throw InputError({"", 0, "--device"}, e.what(), "give --device none for this processor");
  }
}

}  // namespace ropewalk
