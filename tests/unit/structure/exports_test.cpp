// SPDX-License-Identifier: GPL-2.0-or-later
// What leaves for PyBaMM and LAMMPS.
#include "electrode/structure/particle_data.h"
#include "measure/exports.h"
#include "measure_support.h"
#include <nlohmann/json.hpp>
#include <set>

namespace {
using namespace calendem;
using namespace calendem_test;

// A body of 8 primaries and one of a single one, both in a cell of 12 x 10 x 8.
SimulatedStructure two_bodies() {
  SimulatedStructure s;
  s.cell = {12.0, 10.0, 8.0};
  s.lattice = kLattice;
  for (int k = 0; k < 8; ++k)
    s.spheres.push_back(
        {Eigen::Vector3d(2, 2, 2) + kLattice * Eigen::Vector3d(k & 1, k >> 1 & 1, k >> 2), kPrimary,
         1});
  s.spheres.push_back({{8, 7, 4}, kPrimary, 2});
  return s;
}

// Balls of 8 and 1 cells have radii 2 r and r: sum of r^3 over sum of r^2 is 9/5 r.
TEST(BpxFragment, HasTheRadiusAndSurfaceOfTheBodiesAsBalls) {
  const ElectrodeOfBpx e = electrode_of_bpx(two_bodies(), 0.25);
  const double r = std::cbrt(0.75 / kPi) * kLattice, cells = 9.0 * std::pow(kLattice, 3);
  EXPECT_NEAR(e.particle_radius, 1.8 * r, 1e-12);
  EXPECT_NEAR(e.active_fraction, cells / (12.0 * 10.0 * 8.0), 1e-12);
  EXPECT_NEAR(e.porosity, 1.0 - e.active_fraction, 1e-12); // no CBD
  EXPECT_EQ(e.thickness, 8.0);
  const double surface = 4.0 * kPi * 5.0 * r * r; // of both balls
  const nlohmann::ordered_json j = bpx_fragment(e, "two bodies");
  const auto &electrode = j["Parameterisation"]["Positive electrode"];
  EXPECT_NEAR(electrode["Surface area per unit volume [m-1]"].get<double>(),
              surface / (12.0 * 10.0 * 8.0) * 1e6, 1e-3);
  EXPECT_NEAR(electrode["Thickness [m]"].get<double>(), 8e-6, 1e-18);
  EXPECT_NEAR(electrode["Particle radius [m]"].get<double>(), 1.8e-6 * r, 1e-18);
}

// Through a medium with a share e of pores the efficiency lies between 0 and e.
TEST(BpxFragment, TransportIsThatThroughTheThickness) {
  const SimulatedStructure s = two_bodies();
  const ElectrodeOfBpx e = electrode_of_bpx(s, 0.25);
  const double through = tortuosity(voxelise(s.spheres, s.cell, s.lattice, 0.25), 2).effective;
  EXPECT_EQ(e.transport_efficiency, through);
  EXPECT_GT(e.transport_efficiency, 0.9);
  EXPECT_LT(e.transport_efficiency, e.porosity);
  const auto more = bpx_fragment(e, "")["Parameterisation"]["User-defined"];
  EXPECT_NEAR(std::pow(e.porosity, more["Positive electrode Bruggeman exponent"].get<double>()),
              through, 1e-12);
  EXPECT_EQ(more["Positive electrode tortuosity factor of the macro pores"].get<double>(),
            e.macro_porosity / through);
}

// Schema of BPX 0.4 (bpx/schema.py of FaradayInstitution/BPX): the version is a number, no field that
// it does not know, every user-defined value a number with a point (whole ones are refused).
TEST(BpxFragment, KeepsTheRulesOfTheSchema) {
  const std::set<std::string> electrode = {
      "Thickness [m]",         "Porosity",
      "Transport efficiency",  "Conductivity [S.m-1]",
      "Minimum stoichiometry", "Maximum stoichiometry",
      "Particle radius [m]",   "Surface area per unit volume [m-1]"};
  const nlohmann::json j =
      nlohmann::json::parse(bpx_fragment(electrode_of_bpx(two_bodies(), 0.25), "a").dump());
  EXPECT_TRUE(j["Header"]["BPX"].is_number_float());
  EXPECT_EQ(j["Header"]["BPX"], 0.4);
  EXPECT_EQ(j["Header"]["Model"], "DFN");
  EXPECT_EQ(j["Header"].size(), 3u);
  for (const auto &[part, values] : j["Parameterisation"].items()) {
    EXPECT_TRUE(part == "Positive electrode" || part == "User-defined") << part;
    for (const auto &[field, value] : values.items()) {
      EXPECT_TRUE(part == "User-defined" || electrode.count(field)) << field;
      EXPECT_TRUE(value.is_number_float()) << field;
    }
  }
}

struct Exported {
  ParticleFrame particles;
  BondFrame bonds;
  std::map<long, double> mass{{1, 10.0}, {2, 10.0}, {3, 2.0}};

  Exported() {
    particles.centre = {{11.5, 2, 3}, {12.5, -1, 3}, {5, 6, 1}};
    particles.radius = {0.8, 0.8, 0.65};
    particles.body = {7, 7, 0};
    particles.tag = {1, 2, 3};
    particles.type = {1, 1, 3};
    bonds.tags = {{1, 2}, {1, 3}};
    bonds.intact = {true, false};
  }
  std::string text() const { return lammps_data(particles, bonds, {12, 10, 8}, mass, "title"); }
};

TEST(LammpsExport, ReadsBackAsAtomsOfTheirBodiesWithTheirMasses) {
  const std::string file = (test_folder() / "run.data").string();
  std::ofstream(file) << Exported().text();
  Mistakes mistakes(file);
  const ParticleData d = read_particle_data(file, {"bpm/sphere", 1.0, 1.0, false}, mistakes);
  mistakes.stop_if_any();
  ASSERT_EQ(d.particles.size(), 3u);
  EXPECT_EQ(d.box, Eigen::Vector3d(12, 10, 8));
  EXPECT_EQ(d.particles[0].molecule, 7);
  EXPECT_EQ(d.particles[2].molecule, 0);
  EXPECT_EQ(d.particles[2].type, 3);
  EXPECT_NEAR((d.particles[1].x - Eigen::Vector3d(0.5, 9, 3)).norm(), 0.0, 1e-8);
  for (const DataParticle &p : d.particles)
    EXPECT_NEAR(p.density * kPi / 6.0 * std::pow(p.diameter, 3), p.id == 3 ? 2.0 : 10.0, 1e-6);
}

TEST(LammpsExport, HasTheIntactBonds) {
  Exported e;
  expect_parts(e.text(), {"\n1 bonds\n1 bond types\n", "\nBonds\n\n1 1 1 2\n"});
  EXPECT_EQ(e.text().find("1 1 3\n", e.text().find("Bonds")), std::string::npos);
  e.bonds.intact = {false, false};
  EXPECT_EQ(e.text().find("Bonds"), std::string::npos);
}

TEST(LammpsExport, OfAnotherElectrodeIsRefused) {
  Exported e;
  e.mass.erase(2);
  expect_parts(refusal([&] { e.text(); }), {"particle 2 of the run", "--electrode"});
  e.particles.tag.clear();
  expect_parts(refusal([&] { e.text(); }), {"the frames have no tags"});
}

TEST(ImageExport, CbdHasANumberOfItsOwn) {
  PhaseImage image = empty_phases({4, 1, 1}, Eigen::Vector3d::Ones(), true);
  image.label = {0, kCbdLabel, 1, 5};
  EXPECT_EQ(with_phases(image).label, (std::vector<std::int32_t>{0, 2, 1, 1}));
  EXPECT_EQ(with_labels(image).label, (std::vector<std::int32_t>{0, 6, 1, 5}));
}

} // namespace
