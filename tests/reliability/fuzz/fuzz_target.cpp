// SPDX-License-Identifier: GPL-2.0-or-later
// One reader under libFuzzer: every input either works or throws Failure with exit status 2 and a
// message. FUZZ_TARGET: recipe, case_, experiment, csv or structure (a macro of fuzz.sh).
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <unistd.h>

#include "spec/case.h"
#include "spec/csv_table.h"
#include "spec/experiment.h"
#include "spec/messages.h"
#include "spec/recipe.h"
#include "structure/given_structure.h"

namespace {

const std::string &file() {
  static const std::string name = "/dev/shm/calendem_fuzz_" + std::to_string(getpid());
  return name;
}

void recipe(const std::string &) { calendem::read_recipe(file()); }
void case_(const std::string &) { calendem::read_case(file()); }
void experiment(const std::string &) { calendem::read_experiment(file()); }
void csv(const std::string &text) {
  const auto table = calendem::CsvTable::parse(text);
  for (const std::string &column : table.header())
    if (table.has(column))
      table.numbers(column);
}

// The first byte says how the data file is to be read; the file follows.
void structure(const std::string &text) {
  if (text.empty())
    return;
  std::ofstream(file(), std::ios::binary) << text.substr(1);
  const char *const styles[] = {"sphere", "granular", "bpm/sphere", "hybrid"};
  calendem::StructureSource source;
  source.file = file();
  source.atom_style = styles[text[0] & 3];
  source.z_periodic = text[0] & 4;
  source.clusters = text[0] & 8;
  source.body_map = text[0] & 16 ? file() : "";
  source.am_types = {1, 2};
  source.cbd_types = {3};
  const calendem::GivenStructure g = calendem::read_structure(source);
  for (const auto *phase : {&g.am, &g.cbd})
    for (const calendem::GivenSphere &p : *phase)
      if (!(p.diameter > 0.0 && p.density > 0.0 && p.x.allFinite() && p.x.z() > 0.0))
        std::abort();
  if (g.am.empty() || !(g.thickness > 0.0) || g.thickness > g.extent)
    std::abort();
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
