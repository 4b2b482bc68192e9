// SPDX-License-Identifier: GPL-2.0-or-later
// Writes tests/support/made_coatings.fit.json: the hyperparameters that tests on made coatings take.
#include "support/made_coatings.h"
#include <iostream>

int main() {
  using namespace calendem_test;
  const inference::Emulator emulator(bank::training_of(made_coatings()));
  std::cout << nlohmann::json(emulator.hyperparameters()).dump() << "\n";
}
