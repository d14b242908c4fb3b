#include "python/module.hpp"

#include "io/data_files.hpp"
#include "sim/contact/line/engine.hpp"
#include "sim/threads/threads.hpp"
#include "version.hpp"

PYBIND11_MODULE(_core, m) {
  using namespace ropewalk;
  m.attr("version") = version;
  m.attr("git_id") = git_id;
  m.def("set_data_directory", set_data_directory, pybind11::arg("folder"));
  m.def("data_directory", data_directory);
  m.attr("most_threads") = most_threads;
  m.def("threads", threads_in_use);
  m.def("set_threads", use_threads, pybind11::arg("threads"));
  m.def("instructions", instructions_in_use);
  python::bind_errors(m);
  python::bind_observables(m);
  python::bind_scene(m);
  python::bind_simulation(m);
  python::bind_frames(m);
  python::bind_run_files(m);
  python::bind_runs(m);
  python::bind_energy(m);
  python::bind_atoms(m);
}
