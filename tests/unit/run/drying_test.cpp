// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/provenance.h"
#include "simulate/collect.h"
#include "support/test_folder.h"
#include <cmath>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace {

using namespace calendem;

const std::string kHeader = "time_us,shrinkage,film_tension_MPa,top_um,broken_am,broken_cbd,"
                            "broken_collector,kinetic_fJ,shrinking_fJ,left_over_fJ\n";

std::string folder_with(const std::string &rows) {
  const std::string folder = calendem_test::test_folder().string();
  write_file(folder + "/drying.csv", kHeader + rows);
  return folder;
}

// Requirement: the film as the press finds it, and the worst of the ledger on the way.
TEST(DriedFilm, IsThatOfTheLastRow) {
  const nlohmann::json film = dried_film(folder_with("0.1,0.001,0.002,16.8,0,1,0,9,50,-3\n"
                                                     "0.2,0.003,0.004,16.7,3,2,1,0.5,100,1\n"));
  EXPECT_EQ(film["shrinkage"], 0.003);
  EXPECT_EQ(film["film_tension_MPa"], 0.004);
  EXPECT_EQ(film["height_of_top_um"], 16.7);
  EXPECT_EQ(film["bridges_broken"], nlohmann::json({{"am", 3}, {"cbd", 2}, {"collector", 1}}));
  EXPECT_EQ(film["unaccounted_fraction"], 0.03);
}

TEST(DriedFilm, NoneWithoutTheEffect) {
  EXPECT_TRUE(dried_film(calendem_test::test_folder().string()).is_null());
}

TEST(DriedFilm, ALedgerThatIsNoNumberShows) {
  const nlohmann::json film = dried_film(folder_with("0.1,0.001,0.002,16.8,0,1,0,9,50,nan\n"
                                                     "0.2,0.003,0.004,16.7,3,2,1,0.5,100,1\n"));
  EXPECT_TRUE(std::isnan(film["unaccounted_fraction"].get<double>()));
}

} // namespace
