// The module ropewalk._core: the libraries as the package `ropewalk` needs them. The package has the classes that
// users see, with their documentation; here only simple values and arrays go in and out.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

namespace ropewalk::python {

namespace py = pybind11;

void bind_errors(py::module_& m);
void bind_observables(py::module_& m);
void bind_scene(py::module_& m);
void bind_simulation(py::module_& m);
void bind_frames(py::module_& m);
void bind_run_files(py::module_& m);
void bind_runs(py::module_& m);
void bind_energy(py::module_& m);
void bind_atoms(py::module_& m);

}  // namespace ropewalk::python
