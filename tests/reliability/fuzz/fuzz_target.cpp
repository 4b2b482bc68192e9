// SPDX-License-Identifier: GPL-2.0-or-later
// One reader under libFuzzer: every input either works or throws Failure with exit status 2 and a
// message. FUZZ_TARGET: recipe, case_, experiment or csv (a macro of fuzz.sh).
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <unistd.h>

#include "report/csv_table.h"
#include "spec/case.h"
#include "spec/experiment.h"
#include "spec/messages.h"
#include "spec/recipe.h"

namespace {

const std::string &file() {
  static const std::string name = "/dev/shm/calendem_fuzz_" + std::to_string(getpid());
  return name;
}

void recipe(const std::string &) { calendem::read_recipe(file()); }
void case_(const std::string &) { calendem::read_case(file()); }
void experiment(const std::string &) { calendem::read_experiment(file()); }
void csv(const std::string &text) {
  const auto table = calendem::report::CsvTable::parse(text);
  for (const std::string &column : table.header())
    if (table.has(column))
      table.numbers(column);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char *data, std::size_t size) {
  const std::string text(reinterpret_cast<const char *>(data), size);
  std::ofstream(file(), std::ios::binary) << text;
  try {
    FUZZ_TARGET(text);
  } catch (const calendem::Failure &f) {
    if (f.exit_status() != calendem::kBadInput || std::strlen(f.what()) < 10)
      std::abort();
  }
  unlink(file().c_str());
  return 0;
}
