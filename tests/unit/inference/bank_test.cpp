// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/messages.h"
#include "synthetic_bank.h"
#include <gtest/gtest.h>

namespace calendem::inference {
namespace {

std::string message_of(const std::function<void()> &action) {
  try {
    action();
  } catch (const Failure &f) {
    EXPECT_EQ(f.exit_status(), kBadInput);
    return f.what();
  }
  return "no failure";
}

TEST(Prior, ScoresAndValuesAreInverse) {
  for (const Prior &p : {Prior{Prior::normal, 3.0, 0.5}, Prior{Prior::uniform, -1.0, 4.0},
                         Prior{Prior::log_uniform, 0.1, 10.0}})
    for (const double score : {-2.0, -0.3, 0.0, 1.7})
      EXPECT_NEAR(p.score(p.value(score)), score, 1e-9);
  EXPECT_NEAR((Prior{Prior::log_uniform, 0.1, 10.0}).value(0.0), 1.0, 1e-12);
  EXPECT_NEAR((Prior{Prior::normal, 3.0, 0.5}).scaled(4.0), 1.0, 1e-12);
}

TEST(Bank, RunsThatCannotServeAreReported) {
  Bank bank = synthetic_bank(8, 0.1);
  bank.runs[1].packing = "another";
  EXPECT_NE(message_of([&] { check(bank); }).find("'plasticity': 1 of its 8 runs"),
            std::string::npos);
  bank = synthetic_bank(8, 0.1);
  bank.runs[0].values[3] = NAN;
  EXPECT_NE(
      message_of([&] { check(bank); }).find("run 1: ln pressure|compression|p150|0.272727 is not"),
      std::string::npos);
  bank = synthetic_bank(5, 0.1);
  EXPECT_NE(message_of([&] { check(bank); }).find("5 runs of the base model; at least 7"),
            std::string::npos);
}

TEST(Observables, WhatTheExperimentMustBe) {
  ObservableVector e = synthetic_experiment("", 0.0, 1, 0.1, 0.1);
  e.covariance(0, 1) = e.covariance(1, 0) = 0.011;
  EXPECT_NE(message_of([&] { check(e); }).find("not symmetric and positive definite"),
            std::string::npos);
  e = synthetic_experiment("", 0.0, 1, 0.1, 0.1);
  e.covariance(2, 2) = 0.0;
  EXPECT_NE(message_of([&] { check(e); }).find("variance 0; a number and a variance above 0"),
            std::string::npos);
  EXPECT_NE(message_of([&] {
              places_in(e.of, {{"mass", "rest", "p80", 0.0}});
            }).find("mass|rest|p80|0"),
            std::string::npos);
}

} // namespace
} // namespace calendem::inference
