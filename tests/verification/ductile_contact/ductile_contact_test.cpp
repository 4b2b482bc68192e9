// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include <cmath>

#include <gtest/gtest.h>

#include "physics/ductile_contact.h"
#include "physics/hertz_contact.h"
#include "physics/kept_volume.h"
#include "spheres.h"

using namespace calendem;

namespace {

constexpr double E = 2e6, nu = 0.3, R = 0.658, H = 1.2e5, K = 1.7e6, kSpeed = 0.2, kStep = 1e-4;
const double volume = 4.0 / 3.0 * kPi * R * R * R;

std::vector<Vec3> towards(int neighbours) {
  if (neighbours == 2)
    return {{1, 0, 0}, {-1, 0, 0}};
  return {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
}

/// The files of a crowd; type of the neighbours: 1 ductile, 2 rigid beside the first.
Files crowd(int neighbours, int type) {
  std::ostringstream data, map, start, back;
  for (std::ostringstream *s : {&data, &map, &start, &back})
    s->precision(17);
  data << "a crowd\n\n"
       << neighbours + 1 << " atoms\n2 atom types\n"
       << "-4 4 xlo xhi\n-4 4 ylo yhi\n-4 4 zlo zhi\n\nAtoms\n\n"
       << "1 1 " << 2 * R << " 1 0 0 0\n";
  map << "1 1\n";
  int tag = 1;
  for (const Vec3 &n : towards(neighbours)) {
    ++tag;
    const Vec3 x = 2 * R * n, v = -kSpeed * n;
    data << tag << " " << type << " " << 2 * R << " 1 " << x.x << " " << x.y << " " << x.z << "\n";
    map << tag << " " << tag << "\n";
    start << "set atom " << tag << " vx " << v.x << " vy " << v.y << " vz " << v.z << "\n";
    back << "set atom " << tag << " vx " << -v.x << " vy " << -v.y << " vz " << -v.z << "\n";
  }
  return {{"atoms.data", data.str()},
          {"bodies.map", map.str()},
          {"start.in", start.str()},
          {"back.in", back.str()}};
}

Settings ductile(int steps, int back = 0) {
  return {{"Ey", number(E)},
          {"nu", number(nu)},
          {"dt", number(kStep)},
          {"hardness", number(H)},
          {"full", number(K)},
          {"every", "1"},
          {"steps", std::to_string(steps)},
          {"back", std::to_string(back)}};
}

/// The law and the growth of the spheres step by step, as the program is to do them.
struct ByHand {
  int neighbours, type;
  DuctileContact law;
  DuctileContact::State state;
  KeptVolume middle, outer;
  double overlap = 0.0, taken = 0.0;

  ByHand(int z, int of_type)
      : neighbours(z), type(of_type),
        law({effective_modulus(E, nu, of_type == 1 ? E : 2e8, of_type == 1 ? nu : 0.3), 0.5 * R, R},
            {H, K, 0.0}) {}

  void step(int n, double to) {
    const double a = R + middle.growth, b = R + outer.growth;
    taken +=
        law.advance(overlap, to, kStep, state,
                    {effective_radius(a, b), std::fmin(a, b), middle.growth + outer.growth,
                     middle.full || outer.full, flat_depth(1.0, 0.5 * R, R, type == 1 ? 2 : 1)});
    overlap = to;
    if (n % 50 == 0) {
      grow(middle, neighbours);
      if (type == 1)
        grow(outer, 1);
    }
  }
  void grow(KeptVolume &sphere, int contacts) const {
    const double depth = flat_depth(std::fmax(overlap, 0.0), 0.5 * R, R, type == 1 ? 2 : 1);
    const Cap cap(R + sphere.growth, R - depth);
    sphere.update(R, overlap > 0.0 ? contacts * cap.volume : 0.0,
                  overlap > 0.0 ? contacts * cap.area : 0.0);
  }
};

struct Errors {
  double force = 0.0, elastic = 0.0, ledger = 0.0, growth = 0.0; ///< of the largest value
  double densest = 0.0, allowed = 0.0;                           ///< density there, and 1 + p/K
  double pressure = 0.0; ///< there, of the middle sphere [kPa]
};

Errors pressed(int z, int type, int steps, int back) {
  const CaseRun run("ductile_contact/in.crowd", ductile(steps, back), 1, crowd(z, type));
  EXPECT_TRUE(run.finished()) << run.why();
  ByHand law(z, type);
  Errors worst;
  double force = 0.0, work = 0.0, most = 0.0, before = 0.0, x_before = 2 * R;
  size_t next = 0;
  const std::vector<Row> rows = run.rows("curve.csv");
  EXPECT_EQ(rows.size(), size_t(steps + back));
  for (int n = 1; n <= steps + back; ++n) {
    const double moved = kSpeed * kStep * (n <= steps ? n : 2 * steps - n);
    law.step(n, moved);
    const Row &row = rows.at(next++);
    const double f = law.law.force(law.overlap, law.state);
    force = std::fmax(force, f);
    work += 0.5 * z * (row.at("f") + before) * (x_before - row.at("x"));
    most = std::fmax(most, work);
    before = row.at("f");
    x_before = row.at("x");
    worst.force = std::fmax(worst.force, std::fabs(row.at("f") - f));
    worst.elastic =
        std::fmax(worst.elastic, std::fabs(row.at("elastic") -
                                           z * law.law.elastic_energy(law.overlap, law.state)));
    worst.ledger = std::fmax(worst.ledger, std::fabs(work - row.at("elastic") - row.at("taken")));
    if (n == steps) {
      const double r = R - flat_depth(moved, 0.5 * R, R, type == 1 ? 2 : 1);
      worst.densest = volume / (8.0 * r * r * r);
      worst.pressure = f / (4.0 * r * r);
      worst.allowed = 1.0 + worst.pressure / K;
    }
  }
  worst.force /= force;
  worst.elastic /= most;
  worst.ledger /= most;
  std::printf("%d neighbours of type %d: force %.1e, elastic %.1e, ledger %.1e; density %.3f at "
              "%.3f GPa, %.3f allowed\n",
              z, type, worst.force, worst.elastic, worst.ledger, worst.densest,
              1e-6 * worst.pressure, worst.allowed);
  return worst;
}

void expect_small(const Errors &e) {
  EXPECT_LT(e.force, 1e-9);
  EXPECT_LT(e.elastic, 1e-9);
  EXPECT_LT(e.ledger, 1e-7); // trapezoids, 19000 steps
}

std::string last_frame(const CaseRun &run) {
  const std::string all = run.text("spheres.dump");
  return all.substr(all.rfind("ITEM: ATOMS"));
}

} // namespace

TEST(VerificationDuctileContact, FollowsTheLawBetweenTwoNeighbours) {
  expect_small(pressed(2, 1, 15000, 4000));
  expect_small(pressed(2, 2, 15000, 4000));
}

// To full density and beyond, out and the dents stay; never denser than the bulk allows.
TEST(VerificationDuctileContact, FillsItsCellAndNoMore) {
  for (const auto &[type, steps] : {std::pair(1, 14000), std::pair(2, 9900)}) {
    const Errors e = pressed(6, type, steps, 4000);
    expect_small(e);
    EXPECT_GT(e.densest, 1.0) << type;
    EXPECT_LT(e.densest, e.allowed) << type;
  }
}

// Two ranks and a restart give the same to the last digit.
TEST(VerificationDuctileContact, SameOnTwoRanksAndAfterARestart) {
  const Files files = crowd(6, 1);
  Settings settings = ductile(14000);
  settings["half"] = "6010";
  const CaseRun once("ductile_contact/in.crowd", settings, 1, files);
  ASSERT_TRUE(once.finished()) << once.why();
  Settings resumed = ductile(14000);
  resumed.insert({{"restart", "1"}, {"begin", "nothing.in"}});
  Files with_restart = files;
  with_restart["nothing.in"] = "# its velocities are in the restart file\n";
  with_restart["half.restart"] = once.text("half.restart");
  const CaseRun again("ductile_contact/in.crowd", resumed, 1, with_restart);
  ASSERT_TRUE(again.finished()) << again.why();
  EXPECT_EQ(last_frame(once), last_frame(again));
  settings["gx"] = "2";
  const CaseRun ranks("ductile_contact/in.crowd", settings, 2, files);
  ASSERT_TRUE(ranks.finished()) << ranks.why();
  EXPECT_EQ(last_frame(once), last_frame(ranks));
}
