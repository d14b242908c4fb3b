// log.csv as columns; manifest and limits as checked JSON; parameter sets.
#include "io/data_files.hpp"
#include "io/files.hpp"
#include "io/grade.hpp"
#include "io/limits_file.hpp"
#include "io/log.hpp"
#include "io/log_mean.hpp"
#include "io/manifest.hpp"
#include "io/parameters_toml.hpp"
#include "python/arrays.hpp"
#include "run/results.hpp"
#include "run/run_directory.hpp"

namespace ropewalk::python {

void bind_run_files(py::module_& m) {
  // (rows, columns), with the columns of observables().
  m.def("read_log", [](const std::string& path) {
    refuse_strange(path);
    const std::vector<LogRow> rows = read_log(path);
    const auto columns = static_cast<py::ssize_t>(observables().size());
    py::array_t<double> out({static_cast<py::ssize_t>(rows.size()), columns});
    auto values = out.mutable_unchecked<2>();
    for (py::ssize_t r = 0; r < values.shape(0); ++r)
      for (py::ssize_t c = 0; c < columns; ++c)
        values(r, c) = rows[static_cast<std::size_t>(r)].values()[static_cast<std::size_t>(c)];
    return out;
  });
  // Statistics of values at these times (ps): mean, error, correlation time and the time needed for an error (ps).
  m.def("mean_over_time", [](const std::vector<double>& times, const std::vector<double>& values) {
    std::vector<LogRow> log(times.size());
    const std::size_t any = index_of_observable("kinetic_eV");
    for (std::size_t k = 0; k < times.size(); ++k)
      log[k]["time_ps"] = times[k], log[k].values()[any] = values.at(k);
    const LogMean mean = mean_of_last(log.size(), log, [any](const LogRow& row) { return row.values()[any]; });
    return py::make_tuple(mean.value, mean.error, mean.correlation_ps, mean.needed_ps);
  });
  // The frames of a run: GSD or the text dump, whichever is there.
  m.def("frames_file", [](const std::string& directory) { return RunDirectory{directory}.frames(); });
  m.def("manifest_json", [](const std::string& path) {
    refuse_strange(path);
    return manifest_json(read_manifest(path));
  });
  // A file, or the name of a shipped set: its path, name and grade.
  m.def("parameter_set", [](const std::string& name) {
    const std::string path = find_parameters(name, "", {"", 0, "parameters"});
    const ParameterSet set = read_parameters(path);
    return py::make_tuple(path, set.name, grade_of(set).words());
  });
  // The text of a set, of which numbers may be changed.
  m.def("set_to_change", [](const std::string& path) { return with_start_of_pull(read_file(path), path); });
  // What came of a run: the columns that tables of runs have, and whether it is beyond a limit, in words.
  m.def("run_results", [](const std::string& directory) {
    const RunDirectory run{directory};
    refuse_strange_files(run);
    const RunResults r = results_of(run);
    py::dict out;
    out[limit_columns()[0].name] = r.first_limit;
    out[limit_columns()[1].name] = r.first_limit_ps;
    const std::vector<double> values = result_values(r);
    for (std::size_t k = 0; k < values.size(); ++k) out[result_columns()[k].name] = values[k];
    return out;
  });
  m.def("beyond_words", [](const std::string& directory) {
    const RunDirectory run{directory};
    refuse_strange_files(run);
    return beyond_words(limits_of(run));
  });
  m.def("limits_json", [](const std::string& path) {
    refuse_strange(path);
    return limits_json(read_limits(path));
  });
}

}  // namespace ropewalk::python
