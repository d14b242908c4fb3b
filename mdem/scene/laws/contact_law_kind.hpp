// The register of contact laws, from which [contact] law = "name" chooses. A contact law consists of a class
// (sim/contact/contact_law.hpp) and an entry in this register.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "io/toml_table.hpp"
#include "model/contact/tube_ends.hpp"
#include "model/parameters.hpp"
#include "sim/contact/contact_law.hpp"

namespace ropewalk {

struct Scene;

struct ContactLawKind {
  std::string name;
  // The law of a scene, with its cutoff where one is typed.
  std::function<std::shared_ptr<const ContactLaw>(const Scene&)> make;
  // Whether a parameter set has the law's table [contact.name]. Null: the law needs none; it is then never a
  // default.
  bool (*in_set)(const ParameterSet&) = nullptr;
  bool mixes_types = true;         // holds between tubes of different parameter sets
  bool any_element_length = true;  // false: holds for the length of the parameter set alone
  // The contacts of the ends of two tubes in line, of the types i, j at i * types + j; null: the law is that of
  // such ends too.
  std::function<std::vector<EndContact>(const Scene&)> ends = nullptr;
  // Throws InputError for parameter sets that do not go together; null: all do.
  void (*check)(const TomlTable& top, const Scene&) = nullptr;
};

// The shipped laws, and those that were added. The first one that all sets have is the default.
const std::vector<ContactLawKind>& contact_law_kinds();
// For laws from elsewhere; returns true, so that a static variable can do it. The name must be new.
bool add_contact_law(ContactLawKind kind);
// Null for "none", and where there is no such law.
const ContactLawKind* contact_law_kind(const std::string& name);

// The first law that all sets have; where there is none, the last of the shipped ones, which the reader then
// refuses.
std::string default_contact_law(const std::vector<ParameterSet>& sets);

}  // namespace ropewalk
