// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/messages.h"
#include "base/provenance.h"
#include "support/made_coatings.h"
#include "support/test_folder.h"
#include <gtest/gtest.h>
#include <map>

namespace {
using namespace calendem_test;

const Material kMiddle = {{190.0, 2.4, 480.0}, {}};

// Emulators see packings that scatter by 0.2 points; their mean is known to a fraction of that, and the power
// law between five pressures is met to 0.2 points by the cubic.
TEST(FilmBank, MeetsTheFormulaAtAndBetweenPressures) {
  const FilmBank &bank = made_film_bank();
  const Film film = made_film("x", 46.0, 2.2);
  const auto curve = bank.at_pressures(FilmNumber::PorosityAfter, film, kMiddle);
  for (const double p : {20.0, 35.0, 80.0, 110.0, 220.0, 300.0}) {
    const double expected = made_porosity({190.0, 2.4, 480.0, 46.0, 2.2}, 0.0, p);
    EXPECT_NEAR(bank.at(curve, p).mean, expected, 0.005) << p;
    EXPECT_LT(std::sqrt(bank.at(curve, p).variance), 0.005) << p;
  }
}

TEST(FilmBank, AnEffectIsAddedToTheBaseModel) {
  const FilmBank &bank = made_film_bank();
  const Film film = made_film("x", 46.0, 2.2);
  const EffectParameter &key = find_effect("nmc_plasticity").parameter;
  const Material yields = {{190.0, 2.4, 480.0}, {{0, key.amplitude(2.5)}}};
  const auto curve = bank.at_pressures(FilmNumber::PorosityAfter, film, yields);
  EXPECT_NEAR(bank.at(curve, 150.0).mean, made_porosity({190.0, 2.4, 480.0, 46.0, 2.2}, 2.5, 150.0),
              0.01);
}

TEST(FilmBank, BeyondTheBankItWidensAndSaysSo) {
  const FilmBank &bank = made_film_bank();
  const Film inside = made_film("x", 46.0, 2.2), outside = made_film("x", 60.0, 2.2);
  EXPECT_TRUE(bank.beyond(inside).empty());
  ASSERT_EQ(bank.beyond(outside).size(), 1u);
  EXPECT_EQ(bank.beyond(outside)[0], "porosity before 60 %; the bank has 41 to 52 %: extrapolated");
  const auto width = [&](const Film &f) {
    return bank.at_pressures(FilmNumber::PorosityAfter, f, kMiddle)[2].variance;
  };
  EXPECT_GT(width(outside), 4.0 * width(inside));
  EXPECT_TRUE(bank.covers(300.0));
  EXPECT_FALSE(bank.covers(5.0));
}

// A run that lacks rows of its release has no modulus; the others teach it.
TEST(FilmBank, ARunThatLacksANumberIsLeftOutOfIt) {
  bank::Runs runs = made_coatings();
  for (bank::PressedFilm &press : runs.runs[12].presses)
    press.release.assign(bank::kReleasedTo.size(), NAN);
  for (const MeanVariance &g :
       film_bank_of(runs).at_pressures(FilmNumber::LogModulus, made_film("x", 46.0, 2.2), kMiddle))
    EXPECT_NEAR(g.mean, std::log(1.9), 0.02);
  for (bank::Run &run : runs.runs)
    for (bank::PressedFilm &press : run.presses)
      press.release.assign(bank::kReleasedTo.size(), NAN);
  EXPECT_FALSE(film_bank_of(runs).knows(FilmNumber::LogModulus));
}

// A run that jams before the highest pressure counts at the others.
TEST(FilmBank, ARunMayLackTheHighestPressure) {
  bank::Runs runs = made_coatings();
  const auto variances = [](const bank::Runs &of) {
    std::vector<double> out;
    for (const MeanVariance &g : film_bank_of(of).at_pressures(FilmNumber::PorosityAfter,
                                                               made_film("x", 46.0, 2.2), kMiddle))
      out.push_back(g.variance);
    return out;
  };
  const std::vector<double> all = variances(runs);
  for (std::size_t k = 0; k < runs.runs.size(); k += 2)
    runs.runs[k].presses.pop_back();
  const std::vector<double> fewer = variances(runs);
  EXPECT_GT(fewer.back(), 1.2 * all.back());
  for (std::size_t p = 0; p + 1 < all.size(); ++p)
    EXPECT_DOUBLE_EQ(fewer[p], all[p]) << p;
}

/// A recipe of these lines.
Recipe recipe_of(const std::string &text) {
  const auto file = calendem_test::test_folder() / "film.toml";
  write_file(file.string(), "name = \"film\"\n" + text);
  return read_recipe(file.string());
}

// Half of a lognormal's volume lies below its median by number times exp(3 sigma^2), where nothing is cut off.
TEST(SizesByVolume, AreThoseOfALognormal) {
  const Recipe wide =
      recipe_of("[particles]\nmedian_um = 5\nsigma_ln = 0.2\nmin_um = 0.5\nmax_um = 100\n");
  const auto sizes = sizes_by_volume(wide, wide.max_diameter);
  EXPECT_NEAR(sizes[1], 5.0 * std::exp(3.0 * 0.04), 1e-6);
  EXPECT_NEAR(std::log(sizes[2] / sizes[0]), 2.0 * 1.281552 * 0.2, 1e-6);
  const auto cut = sizes_by_volume(wide, 5.0);
  EXPECT_LT(cut[2], 5.0);
}

/// A bank that does not take the nanoporosity of CBD for known.
FilmBank of_unknown_nanopores() {
  bank::Runs runs = made_coatings();
  runs.bank.nanoporosity_within = 10.0;
  return film_bank_of(runs);
}

// BLB's powder has hardly other sizes, and other densities: its film is described by its volumes.
TEST(FilmBank, AFilmOfLikeParticlesIsDescribedByVolume) {
  const FilmBank bank = of_unknown_nanopores();
  const Recipe blb =
      read_recipe(CALENDEM_SOURCE_DIR "/input_scripts/cases/real/blb_nmc111_90/electrode.toml");
  const Film film = bank.film_of(blb);
  const double each = 0.01 * film.recipe[1], cbd = 2.0 * each / 1.83,
               am = (1.0 - 2.0 * each) / 4.65;
  EXPECT_NEAR(cbd / am, (0.1 / 1.89) / (0.9 / 4.75), 1e-9);
  EXPECT_NEAR(10.0 * film.loading * (cbd + am), blb.am_column() + blb.cbd_solid_column(), 1e-9);
  EXPECT_NEAR(std::exp(film.sizes), 9.07 / 8.30, 0.005);
  EXPECT_EQ(bank.film_of(recipe_of("")).sizes, 0.0);
  EXPECT_EQ(bank.film_of(recipe_of("")).loading, 17.46);
  ASSERT_EQ(bank.beyond(film).size(), 1u);
  EXPECT_NE(bank.beyond(film)[0].find("an error of 0.6 points"), std::string::npos);
}

// Only collapse changes it; a domain that begins with fewer pores loses the same share of those that it can lose.
TEST(FilmBank, NanoporesAreWhatCollapseLeaves) {
  const FilmBank bank = of_unknown_nanopores();
  ASSERT_TRUE(bank.knows(FilmNumber::CbdNanoporosity));
  const Film film = made_film("x", 48.0, 3.0);
  const double amplitude = find_effect("cbd_collapse").parameter.amplitude(30.0);
  const auto left = [&](double points, const std::vector<ActiveEffect> &effects,
                        std::size_t pressure) {
    return bank
        .at_pressures(FilmNumber::CbdNanoporosity, film, {{190.0, 2.4, 480.0, points}, effects})
        .at(pressure)
        .mean;
  };
  for (std::size_t p = 0; p < bank.pressures().size(); ++p) {
    EXPECT_NEAR(left(0.0, {}, p), 0.5, 1e-4); // learnt of runs that all have it
    EXPECT_NEAR(left(-10.0, {}, p), 0.4, 1e-4);
    EXPECT_NEAR(left(0.0, {{kCollapses, amplitude}}, p),
                made_nanoporosity(30.0, bank.pressures()[p]), 0.04);
    EXPECT_NEAR(0.4 - left(-10.0, {{kCollapses, amplitude}}, p),
                (0.5 - left(0.0, {{kCollapses, amplitude}}, p)) * 13.0 / 23.0, 0.02);
  }
}

// A film of 92 : 4 : 4 with 48 % pores whose CBD has 40 % nanopores is as thick, and has as much of CBD with its
// nanopores, as one with half of CBD nanopores and 5/6 of the solid CBD.
TEST(FilmBank, FewerNanoporesAreLessOfTheBanksCbd) {
  const FilmBank bank = of_unknown_nanopores();
  ASSERT_EQ(bank.material().back().name, kNanoporosity);
  const double am = 0.92 / 4.65, cbd = 0.08 / 1.83, of_bank = cbd * 5.0 / 6.0,
               thickness = (am + cbd) / 0.52;
  const double weight = of_bank * 1.83 / (of_bank * 1.83 + am * 4.65);
  const Film film = made_film("x", 48.0, 4.0),
             as = made_film("x", 100.0 * (1.0 - (am + of_bank) / thickness), 50.0 * weight);
  const Material fewer = {{190.0, 2.4, 480.0, -10.0}, {}}, same = {{190.0, 2.4, 480.0, 0.0}, {}};
  const auto at = [&](FilmNumber number, const Film &f, const Material &m) {
    return bank.at_pressures(number, f, m)[3];
  };
  const MeanVariance after = at(FilmNumber::PorosityAfter, film, fewer),
                     of_as = at(FilmNumber::PorosityAfter, as, same);
  const double pressed = (am + of_bank) / (1.0 - of_as.mean); // its thickness
  EXPECT_NEAR(after.mean, 1.0 - (am + cbd) / pressed, 1e-12);
  EXPECT_NEAR(std::sqrt(after.variance / of_as.variance), (am + cbd) / (am + of_bank), 1e-12);
  EXPECT_NEAR(at(FilmNumber::Springback, film, fewer).mean,
              at(FilmNumber::Springback, as, same).mean, 1e-12);
  EXPECT_NEAR(bank.nanoporosity(film, fewer), 0.4, 1e-12);
}

// The paper's collapse leaves 27 %: of 40 % of a sphere's volume 13 points can go, of 50 % 23.
TEST(FilmBank, FewerNanoporesHaveLessToLose) {
  const FilmBank bank = of_unknown_nanopores();
  const ActiveEffect collapse = {kCollapses, find_effect("cbd_collapse").parameter.amplitude(10.0)};
  const Film film = made_film("x", 48.0, 4.0);
  const auto lost = [&](double points) {
    const auto broken = [&](const Material &m) {
      return bank.at_pressures(FilmNumber::Broken, film, m)[3].mean;
    };
    const auto porosity = [&](const Material &m) {
      return bank.at_pressures(FilmNumber::PorosityAfter, film, m)[1].mean;
    };
    const Material off = {{190.0, 2.4, 480.0, points}, {}},
                   on = {{190.0, 2.4, 480.0, points}, {collapse}};
    EXPECT_NEAR(broken(on), broken(off), 0.01); // hangs on the strength alone
    return porosity(off) - porosity(on);
  };
  EXPECT_GT(lost(0.0), 0.03);
  // 3.1 % more of solids than the film that stands for it; what is made to collapse is the same in all films. The emulator
  // knows changes of 3 points to some 0.03.
  EXPECT_NEAR(lost(-10.0) / lost(0.0), 0.13 / 0.23 * 1.0311, 0.02);
}

TEST(FilmBank, ARecipesNanoporosityIsTakenWhereItIsNoneOfTheBanksOwn) {
  const Recipe fewer = recipe_of("[cbd]\nnanoporosity_percent = 45\n");
  EXPECT_THROW(made_film_bank().film_of(fewer), Failure);
  const FilmBank bank = of_unknown_nanopores();
  const Film film = bank.film_of(fewer);
  EXPECT_NEAR(bank.nanoporosity(film, {{190.0, 2.4, 480.0, 3.0}, {}}), 0.48, 1e-12);
}

TEST(FilmBank, NanoporesAreUnknownOnlyWhereFilmsDiffer) {
  bank::Runs runs = made_coatings();
  runs.bank.nanoporosity_within = 10.0;
  runs.bank.design.inputs[4].keys = {"case.material.cbd.friction"};
  EXPECT_THROW(film_bank_of(runs), Failure);
}

// Half of this powder's volume lies below a diameter 1.44 times the bank's: 7 points for a factor of e.
TEST(FilmBank, LargerParticlesCountAsAnError) {
  const Recipe coarse =
      read_recipe(CALENDEM_SOURCE_DIR "/input_scripts/cases/real/zhang_nmc111_96/electrode.toml");
  const FilmBank &bank = made_film_bank();
  const Film film = bank.film_of(coarse);
  EXPECT_NEAR(std::exp(film.sizes), 1.44, 0.005);
  ASSERT_EQ(bank.beyond(film).size(), 1u);
  EXPECT_NE(bank.beyond(film)[0].find("an error of 2.6 points"), std::string::npos);
}

// Films of another material get the numbers of the bank's, and are told so; the paper's NMC111 is NMC111.
TEST(FilmBank, OtherMaterialsAreRemarkedOn) {
  const FilmBank &bank = made_film_bank();
  const std::vector<std::string> said =
      bank.beyond(bank.film_of(recipe_of("material = \"nmc811\"\n")));
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("the material is 'NMC811', and the bank's runs are of 'NMC111'"),
            std::string::npos)
      << said[0];
  EXPECT_TRUE(bank.beyond(bank.film_of(recipe_of("material = \"xu2023\"\n"))).empty());
}

TEST(FilmBank, OtherParticlesAreRefused) {
  for (const char *sizes : {"median_um = 9", "sigma_ln = 0.3", "median_um = 2"})
    EXPECT_THROW(made_film_bank().film_of(recipe_of(std::string("[particles]\n") + sizes + "\n")),
                 Failure)
        << sizes;
}

// Larger and thicker cells are 3 points denser: that grows from the bank's loading to theirs by 1 / loading.
TEST(FilmBank, TheLargerCellShiftsFilmsOfItsLoading) {
  const FilmBank &bank = made_film_bank();
  Film film = made_film("x", 46.0, 2.2);
  const auto after = [&](double loading) {
    film.loading = loading;
    return bank.at_pressures(FilmNumber::PorosityAfter, film, kMiddle)[3].mean;
  };
  EXPECT_NEAR(after(12.0) - after(6.0), -kLargerIsDenser, 0.004);
  EXPECT_NEAR(after(8.0) - after(6.0), -0.5 * kLargerIsDenser, 0.004);
}

TEST(FilmBank, SeveralMaterialsAreAskedForAtOnce) {
  const FilmBank &bank = made_film_bank();
  const Film film = made_film("x", 46.0, 2.2);
  const Material other = {{150.0, 3.0, 700.0}, {{kYields, 0.2}}};
  const auto both =
      bank.at_pressures(FilmNumber::Cracked, film, std::vector<const Material *>{&kMiddle, &other});
  for (std::size_t p = 0; p < bank.pressures().size(); ++p) {
    EXPECT_NEAR(both[1][p].mean, bank.at_pressures(FilmNumber::Cracked, film, other)[p].mean,
                1e-12); // of sums in another order
    EXPECT_NE(both[0][p].mean, both[1][p].mean);
  }
}

TEST(FilmBank, ASlopeAtTheBanksEndsIsOneSided) {
  const FilmBank &bank = made_film_bank();
  const double step = std::exp(0.05);
  EXPECT_DOUBLE_EQ(bank.beside(10.0).first, 10.0);
  EXPECT_DOUBLE_EQ(bank.beside(10.0).second, 10.0 * step);
  EXPECT_DOUBLE_EQ(bank.beside(300.0).first, 300.0 / step);
  EXPECT_DOUBLE_EQ(bank.beside(300.0).second, 300.0);
  EXPECT_DOUBLE_EQ(bank.beside(80.0).first * step * step, bank.beside(80.0).second);
}

} // namespace
