// manifest.json: the program and the inputs of a run, and how it ended. About the machine it says only the number
// of threads.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/outputs.hpp"

namespace ropewalk {

struct Manifest {
  std::string version;
  std::string git_id;
  std::string compiler;
  std::string build_type;
  std::string instructions;
  std::string device;  // name of the device that moved the elements; empty: none
  std::string program;     // its name
  std::string own_parts;   // that the program has and the run needs, as own_parts_of_run() lists them; empty: none
  std::string own_forces;  // of Python, as own_forces_in_words() lists them; empty: none
  int threads = 0;
  std::uint64_t seed = 0;
  std::string scene_hash;      // xxh64, hex
  std::string parameter_hash;  // xxh64, hex
  std::string grade;           // of each set, as grades_of() words it
  std::string started;         // ISO 8601, UTC
  double wall_seconds = 0;
  std::int64_t steps = 0;
  double time_step_fs = 0;
  std::string status;  // running, finished, interrupted, stopped, refined, failed, not relaxed, taken from atoms
  std::string reason;  // in words; may be empty
  std::string scene;   // its name
};

std::vector<OutputColumn> manifest_keys();
std::string manifest_json(const Manifest& manifest);

// Throws InputError for a file that is missing, not JSON, or lacks a key.
Manifest read_manifest(const std::string& path);

}  // namespace ropewalk
