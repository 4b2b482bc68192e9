// SPDX-License-Identifier: GPL-2.0-or-later
// Requirements: README.md of this folder.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include <gtest/gtest.h>

#include "spheres.h"

using namespace calendem;

namespace {

/// What a script has of the host, and where it stands.
struct HostUse {
  std::string name;         ///< as on the page
  std::string before = "";  ///< fixes before fix bond/bpm
  std::string behind = "";  ///< and behind it
  std::string between = ""; ///< commands between two runs
  std::string extra = "";   ///< columns of end.txt that it makes
};

void PrintTo(const HostUse &use, std::ostream *out) { *out << use.name; }

const std::string kSpheresToInsert =
    "fix one all particletemplate/sphere 15485863 atom_type 1 density constant 4.65 radius "
    "constant "
    "0.4\nfix some all particledistribution/discrete 15485867 1 one 1.0\n"
    "region up block -4.5 4.5 -4.5 4.5 2.5 4.5 units box\n";

const std::vector<HostUse> kUses = {
    {"nothing"},
    {"fix heat/gran/conduction", "",
     "fix tc all property/global thermalConductivity peratomtype 1.0\n"
     "fix th all property/global thermalCapacity peratomtype 1.0\n"
     "fix heat all heat/gran/conduction initial_temperature 300. contact_area overlap\n"
     "run 0\nset atom 5 property/atom Temp 400.0\n",
     "", "f_Temp f_heatFlux"},
    {"compute contact/atom/gran", "", "compute n all contact/atom/gran\n", "", "c_n"},
    {"compute pair/gran/local", "",
     "compute pairs all pair/gran/local id force history\n"
     "dump pairs all local 50 pairs.txt c_pairs[1] c_pairs[2] c_pairs[4] c_pairs[5] c_pairs[6]\n"},
    {"compute pressure", "",
     "compute t all temp\ncompute p all pressure t virial\nfix p all ave/time 10 1 10 c_p file "
     "pressure.txt\n"},
    {"compute stress/atom", "", "compute s all stress/atom pair\n", "", "c_s[1] c_s[2] c_s[4]"},
    {"compute pe", "", "compute e all pe\nfix e all ave/time 1 1 1 c_e file energy.txt\n"},
    {"compute pe/atom", "", "compute e all pe/atom\n", "", "c_e"},
    {"fix fiber/spring/simple",
     "fix v all property/global characteristicVelocity scalar 2.0\ngroup sixth id 6\n"
     "displace_atoms sixth move -0.15 0 0 units box\n", // springs act from 0.1 of overlap on
     "fix springs all fiber/spring/simple tether 10.0 0 0 0 0\n"},
    {"fix insert/pack",
     kSpheresToInsert +
         "fix ins all insert/pack seed 32452843 distributiontemplate some vel constant 0 0 0 "
         "insert_every 150 start 160 overlapcheck yes all_in yes particles_in_region 6 region "
         "up\n"},
    {"fix insert/rate/region",
     kSpheresToInsert +
         "fix ins all insert/rate/region seed 32452843 distributiontemplate some nparticles 8 "
         "particlerate 2000 insert_every 120 start 130 overlapcheck yes all_in yes region up\n"},
    {"fix massflow/mesh",
     "fix plane all mesh/surface file plane.stl type 1\n"
     "fix flow all massflow/mesh mesh plane count once vec_side 0. 0. -1. delete_atoms yes\n"
     "velocity far set 0 0 -500 units box\n"},
    {"fix massflow/mesh/sieve",
     "fix plane all mesh/surface file plane.stl type 1\n"
     "fix flow all massflow/mesh/sieve mesh plane count multiple vec_side 0. 0. -1. sieveSize 1.0 "
     "sieveSpacing 0.1 sieveStiffness 1e5 sieveDamping 0.0\nvelocity far set 0 0 -500 units box\n"},
    {"fix insert/stream",
     kSpheresToInsert +
         "fix face all mesh/surface/planar file face.stl type 1\n"
         "fix ins all insert/stream seed 32452843 distributiontemplate some nparticles 4 "
         "particlerate 2000 overlapcheck yes all_in no vel constant 0. 0. -500. insertion_face "
         "face "
         "extrude_length 1.3\n"},
    {"fix deform", "", "fix box all deform 10 x final -5.0 5.05 units box\n"},
    {"change_box", "", "", "change_box all y final -5.0 5.05 units box\n"},
    {"compute contact/atom", "", "compute n all contact/atom\n", "", "c_n"},
    {"read_dump", "", "dump early all custom 100 early.txt id type x y z radius\n",
     "read_dump early.txt 200 x y z radius\n"},
    {"fix adapt", "", "variable d equal 1.0+1e-4*step\nfix grow far adapt 50 atom diameter v_d\n"},
    {"fix dt/reset", "", "fix step all dt/reset 60 NULL 4e-5 1 units box\n"},
    {"fix ave/euler", "", "fix euler all ave/euler nevery 50 cell_size_relative 3 parallel yes\n"},
    {"fix freeze", "", "fix still far freeze\n"},
    {"fix rigid", "", "fix rig touching rigid single\n"},
    {"fix continuum/weighted", "",
     "fix weighted all continuum/weighted kernel_radius 2.0 kernel_type Top_Hat compute stress\n"},
    {"delete_atoms", "", "", "delete_atoms group far compress no\n"},
    {"displace_atoms", "", "", "displace_atoms far move 0.5 0 0 units box\n"},
    {"create_atoms", "", "",
     "create_atoms 1 single 0.5 3.5 3.5 units box\nset atom 10 diameter 0.8 density 4.65\n"
     "group held id 10\n"},
    {"set", "", "", "set atom 1 diameter 1.0\n"},
    {"velocity", "", "", "velocity far set 0 0 1 units box\n"},
    {"write_restart", "", "", "write_restart whole.restart\n"},
    {"restart", "", "restart 100 a.restart b.restart\n"},
    {"write_dump", "", "", "write_dump all custom now.txt id x y z fx fy fz\n"},
    {"write_data", "", "", "write_data data.out\n"},
    {"atom_modify sort", "", "atom_modify sort 20 1.0\n"},
    {"run ... pre no", "", "", "run 50 pre no post no\nrun 50 pre no\n"},
    {"run_time", "", "", "run_time 5e-4\n"},
    {"run ... every", "", "", "run 60 every 20 \"print 'bonds $(f_bonds[2])'\"\n"},
    {"reset_timestep", "", "", "reset_timestep 0\n"},
    {"pair_style", "pair_style gran model hertz tangential history\npair_coeff * *\nrun 0\n",
     "pair_style gran model hertz tangential history cohesion bpm surface bpm fused ${fused}\n"
     "pair_coeff * *\n"},
    {"unfix", "", "",
     "unfix bonds\nfix bonds all bond/bpm bodies bodies.map youngs_modulus 2e8 nu 0.3 tensile 1e9 "
     "shear 1e9\n"},
};

// What the plugin or the host refuses, and the words in which it does.
struct Refusal {
  HostUse use;
  std::string words;
};

const std::vector<Refusal> kRefused = {
    {{"fix multisphere", "", "fix ms all multisphere allow_group_and_set yes\n"},
     "fix multisphere leaves pairs of spheres out of LIGGGHTS' first lists"},
    {{"fix concave", "", "fix ms all concave allow_group_and_set yes\n"},
     "leaves pairs of spheres out of LIGGGHTS' first lists"},
    {{"run_style respa", "", "run_style respa 2 2\n"}, "'run_style respa' makes no bonds"},
    {{"fix multicontact/halfspace", "", "fix half all multicontact/halfspace\n"},
     "Surface model is not multicontact"},
    {{"replicate", "", "", "replicate 2 1 1 offset 10 0 0 shift 0 0 0\n"},
     "replicate, parted bonded spheres"},
    {{"delete_bonds", "", "", "delete_bonds all bond 1\n"}, "non-molecular system"},
    {{"compute group/group", "",
      "compute g held group/group chain\nfix g all ave/time 1 1 1 c_g file energy.txt\n"},
     "Pair style does not support compute group/group"},
};

const double kRadius = 0.8;

Files spheres() {
  const std::vector<BodySphere> all = {{{0, 0, 1.5}, kRadius, 0},
                                       {{3.35, 3, -3}, kRadius, 1},
                                       {{4.8, 3, -3}, kRadius, 1, {0, 0.01, 0}},
                                       {{-3.75, 3, -3}, kRadius, 1},
                                       {{0, -2, -3}, kRadius, 0},
                                       {{1.55, -2, -3}, kRadius, 0, {0, 0, 0.2}},
                                       {{3.2, -2, -3}, kRadius, 0},
                                       {{-4.225, 0, -3}, kRadius, 0},
                                       {{4.225, 0, -3}, kRadius, 0, {0, 0.5, 0}}};
  Files files = files_of(all, {-5, -5, -5}, {5, 5, 5});
  files["ranks.in"] = "processors * * *\n";
  files["face.stl"] =
      "solid p\nfacet normal 0 0 -1\nouter loop\nvertex -3.9 -3.9 3.2\nvertex 3.9 3.9 3.2\n"
      "vertex 3.9 -3.9 3.2\nendloop\nendfacet\nfacet normal 0 0 -1\nouter loop\n"
      "vertex -3.9 -3.9 3.2\nvertex -3.9 3.9 3.2\nvertex 3.9 3.9 3.2\nendloop\nendfacet\n"
      "endsolid p\n";
  files["plane.stl"] =
      "solid p\nfacet normal 0 0 1\nouter loop\nvertex -3.9 -3.9 1\nvertex 3.9 -3.9 1\n"
      "vertex 3.9 3.9 1\nendloop\nendfacet\nfacet normal 0 0 1\nouter loop\n"
      "vertex -3.9 -3.9 1\nvertex 3.9 3.9 1\nvertex -3.9 3.9 1\nendloop\nendfacet\n"
      "endsolid p\n";
  return files;
}

Files files_of_use(const HostUse &u) {
  Files files = spheres();
  files["before.in"] = u.before + "# before\n";
  files["behind.in"] = u.behind + "# behind\n";
  files["between.in"] = u.between + "# between\n";
  return files;
}

Settings settings_of(const HostUse &u, const char *fused) {
  Settings settings = {{"fused", fused}};
  if (!u.extra.empty())
    settings["extra"] = "'" + u.extra + "'";
  return settings;
}

// Columns of each sphere at the end, by its tag.
std::map<int, std::vector<double>> end_of(const CaseRun &run) {
  const std::string all = run.text("end.txt");
  std::map<int, std::vector<double>> end;
  const size_t last = all.rfind("ITEM: ATOMS");
  EXPECT_NE(last, std::string::npos) << run.why();
  if (last == std::string::npos)
    return end;
  std::istringstream in(all.substr(all.find('\n', last)));
  for (std::string line; std::getline(in, line);) {
    std::istringstream cells(line);
    const std::vector<double> row(std::istream_iterator<double>(cells), {});
    if (!row.empty())
      end[static_cast<int>(row[0])] = row;
  }
  return end;
}

constexpr int kForceY = 8;

// Both loops compute the same sums in another order: sixty roundings of 2.2e-16 of the largest term, which
// the printed six digits hide.
void compare(const CaseRun &loop, const CaseRun &host) {
  ASSERT_TRUE(host.finished()) << host.why();
  ASSERT_TRUE(loop.finished()) << loop.why();
  EXPECT_EQ(loop.text("counts.txt"), host.text("counts.txt"));
  EXPECT_EQ(loop.text("counts.txt"), "2 2\n");
  const auto got = end_of(loop), expected = end_of(host);
  ASSERT_EQ(got.size(), expected.size());
  for (const auto &[tag, row] : expected) {
    ASSERT_EQ(got.count(tag), 1u) << tag;
    for (size_t k = 0; k < row.size(); ++k)
      EXPECT_NEAR(got.at(tag)[k], row[k], 1e-5 * std::fabs(row[k]) + 1e-7) << tag << " " << k;
  }
  // 0.0025 um of the way were rubbed, and nothing of it has been forgotten
  EXPECT_LT(expected.at(9)[kForceY], -1e4);
  for (const char *file : {"pairs.txt", "pressure.txt", "energy.txt"})
    EXPECT_EQ(loop.text(file), host.text(file)) << file;
}

std::string contents(const std::filesystem::path &file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

class HostStyles : public ::testing::TestWithParam<HostUse> {};

} // namespace

TEST_P(HostStyles, FindTheSameContactsAsBesideTheHostsLoop) {
  const Files files = files_of_use(GetParam());
  const CaseRun loop("in.host", settings_of(GetParam(), "on"), 1, files),
      host("in.host", settings_of(GetParam(), "off"), 1, files);
  compare(loop, host);
}

// Fixes of the host before fix bond/bpm instead of behind it, and the other way round.
TEST(HostStylesInTheOtherOrder, FindTheSameContacts) {
  for (HostUse u : kUses) {
    const bool runs =
        (u.before + u.behind).find("run ") != std::string::npos; // bonds are made first
    if (runs || u.before.empty() == u.behind.empty())
      continue;
    std::swap(u.before, u.behind);
    SCOPED_TRACE(u.name);
    compare(CaseRun("in.host", settings_of(u, "on"), 1, files_of_use(u)),
            CaseRun("in.host", settings_of(u, "off"), 1, files_of_use(u)));
  }
}

// Where spheres change ranks or places in memory; each rank has spheres of the chain and of the rubbing pair.
TEST(HostStylesOnRanks, FindTheSameContactsOnTwoRanks) {
  for (const HostUse &u : kUses) {
    Files halves = files_of_use(u);
    halves["ranks.in"] = "processors 2 1 1\n";
    SCOPED_TRACE(u.name);
    compare(CaseRun("in.host", settings_of(u, "on"), 2, halves),
            CaseRun("in.host", settings_of(u, "off"), 2, halves));
  }
}

TEST(HostStylesRefused, ByName) {
  for (const Refusal &r : kRefused)
    for (const char *fused : {"on", "off"}) {
      const CaseRun run("in.host", settings_of(r.use, fused), 1, files_of_use(r.use));
      EXPECT_FALSE(run.finished()) << r.use.name;
      EXPECT_NE(run.why().find(r.words), std::string::npos) << r.use.name << run.why();
    }
}

// Both copies of a bond through a face give the same force to the last bit, where the cell's sides lie on the
// grid of positions; elsewhere one copy could break alone, which is an error. The cell moves to where the grid
// that it began with is too fine for ghosts.
TEST(HostStylesOnRanks, CopiesOfABondAgreeInADeformedCell) {
  HostUse use = {"fix deform", "", "fix box all deform 1 x final 5.0123 15.0212345 units box\n",
                 "run 37\nprint '$(fx[2]+fx[3]+fx[4]) $(fx[3] != 0)' file sum.txt\n"};
  Files files = files_of_use(use);
  for (const int ranks : {1, 2}) {
    files["ranks.in"] = ranks == 1 ? "processors 1 1 1\n" : "processors 2 1 1\n";
    const CaseRun run("in.host", settings_of(use, "on"), ranks, files);
    ASSERT_TRUE(run.finished()) << run.why();
    EXPECT_EQ(run.text("sum.txt"), "0 1\n");
  }
}

// The host has made its own fix of histories before the plugin's, which could not return them in time.
TEST(HostStylesRefused, ABondFixAfterARunWithoutPairStyleAgain) {
  HostUse late = {"pair_style", "pair_style gran model hertz tangential history\npair_coeff * *\n"
                                "run 0\n"};
  const CaseRun run("in.host", settings_of(late, "on"), 1, files_of_use(late));
  EXPECT_FALSE(run.finished());
  EXPECT_NE(run.why().find("ERROR: fix bond/bpm was defined after a run with this pair_style"),
            std::string::npos)
      << run.why();
}

// The page names every use, and the sources of the host that read lists of contacts are those that were
// gone through for it.
TEST(HostStylesPage, NamesEveryUse) {
  const std::string page = contents(CALENDEM_PAGE);
  ASSERT_FALSE(page.empty()) << CALENDEM_PAGE;
  for (const HostUse &u : kUses)
    EXPECT_NE(page.find("`" + u.name + "`"), std::string::npos) << u.name;
  for (const Refusal &r : kRefused)
    EXPECT_NE(page.find("`" + r.use.name + "`"), std::string::npos) << r.use.name;
}

// Rows whose refusals are tested in between_runs and lost_bonds.
TEST(HostStylesPage, HasNoRowWithoutADeck) {
  std::set<std::string> tested = {"minimize", "neigh_modify one"};
  for (const HostUse &u : kUses)
    tested.insert(u.name);
  for (const Refusal &r : kRefused)
    tested.insert(r.use.name);
  std::istringstream page(contents(CALENDEM_PAGE));
  int rows = 0;
  for (std::string line; std::getline(page, line);) {
    if (line.rfind("| `", 0) != 0)
      continue;
    ++rows;
    std::istringstream cell(line.substr(2, line.find(" | ") - 2));
    for (std::string name; std::getline(cell, name, ',');) {
      name.erase(0, name.find('`') + 1);
      if (!name.empty() && name.find('`') == name.size() - 1) { // a name and nothing else
        EXPECT_EQ(tested.count(name.substr(0, name.size() - 1)), 1u) << name;
      }
    }
  }
  EXPECT_GT(rows, 20);
}

TEST(HostStylesPage, KnowsEverySourceOfTheHostThatReadsContacts) {
  const std::set<std::string> known = {"compute_contact_atom_gran.cpp",
                                       "fix_contact_history.cpp",
                                       "fix_fiber_spring_simple.cpp",
                                       "fix_heat_gran_conduction.cpp",
                                       "fix_multicontact_halfspace.cpp",
                                       "pair_gran.cpp",
                                       "fix_wall_gran.cpp"};
  const std::set<std::string> lists = {"neigh_", "neighb",
                                       "pair.c"}; // make the lists, do not read them
  for (const auto &file : std::filesystem::directory_iterator(CALENDEM_HOST_SOURCE)) {
    if (file.path().extension() != ".cpp")
      continue;
    const std::string name = file.path().filename().string(), text = contents(file.path());
    const bool reads = text.find("listgranhistory") != std::string::npos;
    if (reads && lists.count(name.substr(0, 6)) == 0 &&
        text.find("calendem") == std::string::npos) {
      EXPECT_EQ(known.count(name), 1u)
          << name << " reads contacts; see docs/reference/host_styles.md";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, HostStyles, ::testing::ValuesIn(kUses),
                         [](const ::testing::TestParamInfo<HostUse> &info) {
                           std::string name = info.param.name;
                           std::replace_if(
                               name.begin(), name.end(), [](char c) { return !std::isalnum(c); },
                               '_');
                           return name;
                         });
