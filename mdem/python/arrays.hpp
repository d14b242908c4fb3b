// Arrays of numpy: copies of values, and views of columns.
#pragma once

#include <vector>

#include "python/module.hpp"
#include "sim/state/state.hpp"

namespace ropewalk::python {

template <class T>
py::array_t<T> array_of(const std::vector<T>& values) {
  return py::array_t<T>(static_cast<py::ssize_t>(values.size()), values.data());
}

// A view (n, components) of a block whose first column is this one: read-only, and alive as long as `owner`.
template <std::size_t N>
py::array view_of(const ColumnBlock<N>& block, const Column& first, const py::handle& owner) {
  const auto number = static_cast<py::ssize_t>(sizeof(double));
  py::array view(py::dtype::of<double>(), {static_cast<py::ssize_t>(first.size()), static_cast<py::ssize_t>(N)},
                 {number, number * static_cast<py::ssize_t>(block.stride())}, first.data(), owner);
  view.attr("setflags")(py::arg("write") = false);
  return view;
}
inline py::array view_of(const Vec3Array& v, const py::handle& owner) { return view_of(v, v.x, owner); }
inline py::array view_of(const QuaternionArray& q, const py::handle& owner) { return view_of(q, q.w, owner); }

// The same as an array of its own.
template <class V>
py::array copy_of(const V& v) {
  return py::array(view_of(v, py::none()).attr("copy")("C"));
}

// Both numbered by element. Throws std::invalid_argument for arrays of another shape.
Vec3Array vectors_from(const py::array_t<double>& rows);
QuaternionArray quaternions_from(const py::array_t<double>& rows);

}  // namespace ropewalk::python
