// InputError, NumericalError and BusyError become the exceptions of ropewalk/errors.py, with the same line of text.
#include <new>

#include "model/error.hpp"
#include "python/module.hpp"
#include "python/simulation.hpp"

namespace ropewalk::python {
namespace {

// Classes of ropewalk.errors; never given back, since the interpreter may end after this module.
PyObject* input_error = nullptr;
PyObject* numerical_error = nullptr;
PyObject* busy_error = nullptr;

void raise(PyObject* type, const py::tuple& arguments) { PyErr_SetObject(type, arguments.ptr()); }

void translate(std::exception_ptr thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const InputError& e) {
    raise(input_error, py::make_tuple(e.what(), e.place().file, e.place().line, e.place().key));
  } catch (const NumericalError& e) {
    raise(numerical_error, py::make_tuple(e.what(), e.step(), e.element()));
  } catch (const BusyError& e) {
    raise(busy_error, py::make_tuple(e.what()));
  } catch (const std::bad_alloc&) {
    PyErr_SetString(PyExc_MemoryError,
                    "the memory does not suffice; take fewer or shorter tubes, or fewer threads");
  }
}

}  // namespace

void bind_errors(py::module_&) {
  const py::module_ errors = py::module_::import("ropewalk.errors");
  input_error = py::object(errors.attr("InputError")).release().ptr();
  numerical_error = py::object(errors.attr("NumericalError")).release().ptr();
  busy_error = py::object(errors.attr("BusyError")).release().ptr();
  py::register_exception_translator(translate);
}

}  // namespace ropewalk::python
