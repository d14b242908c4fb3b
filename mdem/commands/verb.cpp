#include "commands/verb.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <cstdlib>

#include "run/cores.hpp"
#include "run/pages/colour_fields.hpp"
#include "sim/contact/line/engine.hpp"
#include "sim/threads/threads.hpp"

namespace ropewalk {

// Before steps that so many threads share (0: all that there are). By default the OpenMP runtime spins for
// milliseconds while it waits, and on a machine that does other work as well a step then takes up to ten times as
// long. Asleep at once, small ropes lose what the second core gains: waking takes as long as the gaps between the
// parallel parts of a step. So: spin for some ten microseconds, then sleep. The runtime reads its settings before
// main: start once more with them, unless the user has chosen otherwise. (Under valgrind, set
// OMP_WAIT_POLICY=passive yourself, or the second start runs outside it.)
void wait_briefly(char** argv, int threads) {
  if ((threads > 0 ? threads : threads_in_use()) == 1) return;
  if (std::getenv("OMP_WAIT_POLICY") || std::getenv("GOMP_SPINCOUNT")) return;
  setenv("GOMP_SPINCOUNT", "2000", 1);
  give_back_cores();
  execv("/proc/self/exe", argv);  // on failure go on as we are: only speed is lost
}

void add_instructions(CLI::App* verb, std::string& name, const char* of, const std::string& by_default) {
  verb->add_option("--instructions", name,
                   fmt::format("Instruction set of {}: {} [default: {}]", of, fmt::join(instruction_sets(), ", "),
                               by_default))
      ->check(CLI::IsMember(instruction_sets()));
}

void add_device(CLI::App* verb, std::string& name, const std::string& by_default) {
  verb->add_option(
      "--device", name,
      "Device that moves the elements (a GPU pays, by estimate, from 20 000 elements on): gpu, "
      "opencl:TEXT for an OpenCL device with TEXT in its name, c++ for its kernels on this processor, or "
      "none [default: " +
          by_default + "]");
}

CLI::Option* add_colour(CLI::App* verb, std::string& colour, const char* what) {
  return verb
      ->add_option("--colour", colour,
                   fmt::format("{} are coloured by: {} [default: moment, where frames have it]", what,
                               fmt::join(colour_words(), ", ")))
      ->check(CLI::IsMember(colour_words()));
}

CLI::Validator thread_range() { return whole_number(1, most_threads); }

}  // namespace ropewalk
