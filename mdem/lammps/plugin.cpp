// ropewalk-lammps-plugin.so: the styles for a LAMMPS with the PLUGIN package; `plugin load` registers them. The
// interface is that of LAMMPS's documentation. LAMMPS's own header is used if it is installed.
#include "lammps.h"
#include "lammps/model.hpp"
#include "lammps/register.hpp"

#if __has_include("lammpsplugin.h")
#include "lammpsplugin.h"
#else
extern "C" {
typedef void* lammpsplugin_factory1(void*);
typedef void* lammpsplugin_factory2(void*, int, char**);
struct lammpsplugin_t {
  const char *version, *style, *name, *info, *author;
  union {
    lammpsplugin_factory1* v1;
    lammpsplugin_factory2* v2;
  } creator;
  void* handle;
};
typedef void (*lammpsplugin_regfunc)(lammpsplugin_t*, void*);
}
#endif

namespace {

namespace ours = ropewalk::lammps;

// The interface takes untyped pointers to functions, one for each style.
template <int k>
void* make_pair(void* lmp) {
  return ours::pair_entries[k].make(static_cast<LAMMPS_NS::LAMMPS*>(lmp));
}
void* make_bond(void* lmp) { return ours::bond_entries[0].make(static_cast<LAMMPS_NS::LAMMPS*>(lmp)); }
template <int k>
void* make_fix(void* lmp, int count, char** words) {
  return ours::fix_entries[k].make(static_cast<LAMMPS_NS::LAMMPS*>(lmp), count, words);
}

constexpr lammpsplugin_factory1* pair_makers[] = {make_pair<0>, make_pair<1>, make_pair<2>};
constexpr lammpsplugin_factory2* fix_makers[] = {make_fix<0>, make_fix<1>, make_fix<2>, make_fix<3>, make_fix<4>};

}  // namespace

extern "C" void lammpsplugin_init(void* lmp, void* handle, void* regfunc) {
  const auto add = reinterpret_cast<lammpsplugin_regfunc>(regfunc);
  lammpsplugin_t plugin{};
  plugin.version = static_cast<LAMMPS_NS::LAMMPS*>(lmp)->version;
  plugin.info = "mesoscopic distinct elements of carbon nanotubes";
  plugin.author = "Ropewalk";
  plugin.handle = handle;
  plugin.style = "pair";
  for (int k = 0; k < 3; ++k) {
    plugin.name = ours::pair_entries[k].name;
    plugin.creator.v1 = pair_makers[k];
    add(&plugin, lmp);
  }
  plugin.style = "bond";
  plugin.name = ours::bond_entries[0].name;
  plugin.creator.v1 = make_bond;
  add(&plugin, lmp);
  plugin.style = "fix";
  for (int k = 0; k < 5; ++k) {
    plugin.name = ours::fix_entries[k].name;
    plugin.creator.v2 = fix_makers[k];
    add(&plugin, lmp);
  }
}
