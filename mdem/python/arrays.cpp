#include "python/arrays.hpp"

#include <stdexcept>

namespace ropewalk::python {
namespace {

template <class V>
V rows_into(const py::array_t<double>& rows, const std::vector<Column V::*>& columns) {
  if (rows.ndim() != 2 || rows.shape(1) != static_cast<py::ssize_t>(columns.size()))
    throw std::invalid_argument("an array (elements, " + std::to_string(columns.size()) + ") is needed");
  const auto r = rows.unchecked<2>();
  V out(static_cast<std::size_t>(rows.shape(0)));
  for (py::ssize_t i = 0; i < r.shape(0); ++i)
    for (std::size_t k = 0; k < columns.size(); ++k)
      (out.*columns[k])[static_cast<std::size_t>(i)] = r(i, static_cast<py::ssize_t>(k));
  return out;
}

}  // namespace

Vec3Array vectors_from(const py::array_t<double>& rows) {
  return rows_into<Vec3Array>(rows, {&Vec3Array::x, &Vec3Array::y, &Vec3Array::z});
}

QuaternionArray quaternions_from(const py::array_t<double>& rows) {
  return rows_into<QuaternionArray>(
      rows, {&QuaternionArray::w, &QuaternionArray::x, &QuaternionArray::y, &QuaternionArray::z});
}

}  // namespace ropewalk::python
