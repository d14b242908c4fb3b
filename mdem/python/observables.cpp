// The table of observables: (name, unit, meaning, group, whether frames have it, whether it is an integer).
#include "observe/observables.hpp"

#include "python/module.hpp"

namespace ropewalk::python {

void bind_observables(py::module_& m) {
  m.def("observables", [] {
    py::list rows;
    for (const Observable& o : observables())
      rows.append(py::make_tuple(o.name, o.unit, o.meaning, group_title(o.group), in_frames(o.group), o.whole));
    return rows;
  });
}

}  // namespace ropewalk::python
