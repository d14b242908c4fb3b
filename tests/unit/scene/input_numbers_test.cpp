// Every number that may have a standard error is found, in whatever table or file it stands.
#include "scene/input_numbers.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "model/error.hpp"
#include "scene/drive_kind.hpp"
#include "scene/scene_keys.hpp"
#include "scene/scene_toml.hpp"
#include "scene/templates.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::HasSubstr;

const std::string top = "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n";

std::vector<InputNumber> of_scene(const Scene& scene, InputNumber::Of of) {
  std::vector<InputNumber> found;
  for (const InputNumber& n : input_numbers(scene))
    if (n.of == of) found.push_back(n);
  return found;
}

const InputNumber& at(const std::vector<InputNumber>& all, const std::string& key) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const InputNumber& n) { return n.key == key; });
  if (found == all.end()) throw std::runtime_error("no " + key);
  return *found;
}

// Whatever drive has force terms has properties, and all numbers of such a table are walked: none is named here.
TEST(InputNumbers, AreAllNumbersOfAllTablesOfProperties) {
  std::size_t tables = 0;
  for (const SceneTable& table : scene_tables()) {
    const auto drive = std::find_if(drive_kinds().begin(), drive_kinds().end(),
                                    [&](const DriveKind& kind) { return kind.table().name == table.name; });
    if (drive != drive_kinds().end()) {
      EXPECT_EQ(table.has_properties, drive->energy != nullptr) << table.name;
    }
    if (!table.has_properties) continue;
    ++tables;
    Scene scene;
    scene.text = table.header() + "\n";
    std::size_t numbers = 0;
    for (const SceneKey& key : table.keys)
      if (key.number)
        scene.text += fmt::format("{} = {{ value = {}, standard_error = 0.5 }}\n", key.key, ++numbers);
    EXPECT_GT(numbers, 0u) << table.name;
    const std::string path = table.name + (table.listed ? ".0." : ".");
    const std::vector<InputNumber> found = input_numbers(scene);
    numbers = 0;
    for (const SceneKey& key : table.keys) {
      if (!key.number) continue;
      EXPECT_EQ(at(found, path + key.key).value, static_cast<double>(++numbers));
      EXPECT_EQ(at(found, path + key.key).standard_error, 0.5);
    }
  }
  EXPECT_GE(tables, 5u) << "damping, tethers, friction, links, failure";
}

// All kinds of `ropewalk new`: what their tables of properties say is there, without an error.
TEST(InputNumbers, OfEveryKindOfSceneAreNamed) {
  for (const SceneTemplate& kind : scene_templates()) {
    SCOPED_TRACE(kind.name);
    Scene scene;
    scene.text = kind.text;
    scene.path = kind.name;
    const TomlTable file = TomlTable::parse(kind.text, kind.name);
    const std::vector<InputNumber> found = input_numbers(scene);
    EXPECT_FALSE(found.empty()) << "damping acts always";
    for (const SceneTable& table : scene_tables()) {
      if (!table.has_properties || !file.has(table.name)) continue;
      const TomlTable first = table.listed ? file.tables(table.name).front() : file.table(table.name);
      for (const SceneKey& key : table.keys)
        if (key.number && first.has(key.key)) {
          EXPECT_TRUE(at(found, table.name + (table.listed ? ".0." : ".") + key.key).typed);
        }
    }
  }
}

const char* const properties = R"([rope]
tubes = 7
length_nm = 7
[damping]
bond_damping_per_ps = {}
[[tether]]
tube = 0
elements = [0]
to_tube = 1
to_elements = [0]
stiffness_nN_per_nm = {}
[[friction]]
strength_pN_per_nm = {}
[[links]]
at_ends = 1
stiffness_nN_per_nm = {}
[failure]
strain = {}
[run]
duration_ps = 1
)";

TEST(InputNumbers, AreReadWithAnErrorAsWithoutOne) {
  const auto scene = [](const std::string& form) {
    const auto number = [&](double value) {
      return form.empty() ? fmt::format("{}", value) : fmt::format(fmt::runtime(form), value, 0.1 * value);
    };
    return scene_of_text(
        top + fmt::format(fmt::runtime(properties), number(5), number(0.2), number(30), number(2), number(0.05)),
        "s.toml");
  };
  const Scene plain = scene(""), with = scene("{{ value = {}, standard_error = {} }}");
  ASSERT_EQ(plain.drives.size(), with.drives.size());
  for (std::size_t k = 0; k < plain.drives.size(); ++k)
    EXPECT_EQ(plain.drives[k]->words(), with.drives[k]->words());
  EXPECT_EQ(plain.damping.bond.rate, with.damping.bond.rate);
  for (const InputNumber& n : of_scene(with, InputNumber::Of::scene)) {
    const bool known = n.standard_error.has_value();
    EXPECT_EQ(known, n.typed) << n.key;
    if (known) {
      EXPECT_NEAR(*n.standard_error, 0.1 * n.value, 1e-12) << n.key;
    }
    EXPECT_FALSE(at(of_scene(plain, InputNumber::Of::scene), n.key).standard_error) << n.key;
  }
  EXPECT_THROW(scene("{{ value = {0}, error = {1} }}"), InputError);
  EXPECT_THROW(scene("{{ value = {0}, standard_error = -{1} }}"), InputError);
}

TEST(InputNumbers, OfFormerKeysAreThoseThatHold) {
  Scene scene;
  scene.text = "[damping]\ncontact_viscosity_eV_ps_per_nm2 = 0\n";
  const std::vector<InputNumber> found = input_numbers(scene);
  EXPECT_EQ(at(found, "damping.contact_viscosity_eV_ps_per_nm2").value, 0);
  EXPECT_TRUE(at(found, "damping.contact_viscosity_eV_ps_per_nm2").typed);
  EXPECT_THROW(at(found, "damping.contact_viscosity_eV_ps_per_nm3"), std::runtime_error);
}

// A length that the user asks for is exact.
TEST(InputNumbers, OfWhatASceneAsksForHaveNoErrors) {
  try {
    scene_of_text(
        top + "[rope]\ntubes = 7\nlength_nm = { value = 7, standard_error = 1 }\n[run]\nduration_ps = 1\n",
        "s.toml");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("s.toml:5: rope.length_nm: is a table, a number is needed"));
  }
}

TEST(InputNumbers, OfFilesAreThoseThatTheMotionDependsOn) {
  const Scene scene = scene_of_text(top +
                                        "[rope]\ntubes = 7\nlength_nm = 7\n[[friction]]\nfrom = \"atoms\"\n[run]\n"
                                        "duration_ps = 1\n",
                                    "s.toml");
  const std::vector<InputNumber> numbers = of_scene(scene, InputNumber::Of::file);
  EXPECT_EQ(numbers.size(), 5u);
  EXPECT_NEAR(*at(numbers, "friction.strength").standard_error / at(numbers, "friction.strength").value, 0.112,
              0.001);
  EXPECT_GT(*at(numbers, "friction.elastic_slip").standard_error, 0);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
