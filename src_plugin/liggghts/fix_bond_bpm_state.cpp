// SPDX-License-Identifier: GPL-2.0-or-later
// fix bond/bpm: per-atom arrays, their migration, and restart.
#include "atom.h"
#include "comm.h"
#include "error.h"
#include "fix_bond_bpm.h"
#include "fix_contact_history.h"
#include "memory.h"
#include "neighbor.h"
#include "output.h"
#include "update.h"
#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;

namespace {
const int kHeader = 23; // values before the list of breaks in the restart record
const int kEventSize = sizeof(BreakEvent) / sizeof(double);
} // namespace

void FixBondBpm::grow_arrays(int nmax) {
  memory->grow(body_, nmax, "bond/bpm:body");
  memory->grow(broken_, nmax, "bond/bpm:broken");
}

void FixBondBpm::copy_arrays(int i, int j, int) {
  body_[j] = body_[i];
  broken_[j] = broken_[i];
}

// The host calls this for every atom at the first set-up too, after init().
void FixBondBpm::set_arrays(int i) {
  const size_t tag = static_cast<size_t>(atom->tag[i]);
  body_[i] = tag < body_of_tag_.size() ? body_of_tag_[tag] : 0;
  broken_[i] = 0;
}

int FixBondBpm::pack_exchange(int i, double *buf) {
  buf[0] = body_[i];
  buf[1] = broken_[i];
  return 2;
}

int FixBondBpm::unpack_exchange(int nlocal, double *buf) {
  body_[nlocal] = static_cast<int>(buf[0]);
  broken_[nlocal] = static_cast<int>(buf[1]);
  return 2;
}

int FixBondBpm::pack_comm(int n, int *list, double *buf, int, int *) {
  for (int k = 0; k < n; ++k) {
    buf[2 * k] = body_[list[k]];
    buf[2 * k + 1] = inset_.empty() ? 0.0 : inset_[list[k]];
  }
  return 2;
}

void FixBondBpm::unpack_comm(int n, int first, double *buf) {
  if (int(inset_.size()) < first + n)
    inset_.resize(first + n, 0.0);
  for (int k = 0; k < n; ++k) {
    body_[first + k] = static_cast<int>(buf[2 * k]);
    inset_[first + k] = buf[2 * k + 1];
  }
}

int FixBondBpm::pack_restart(int i, double *buf) {
  buf[0] = 3;
  buf[1] = body_[i];
  buf[2] = broken_[i];
  return 3;
}

void FixBondBpm::unpack_restart(int nlocal, int nth) {
  double *values = atom->extra[nlocal];
  int m = 0;
  for (int i = 0; i < nth; ++i)
    m += static_cast<int>(values[m]);
  body_[nlocal] = static_cast<int>(values[m + 1]);
  broken_[nlocal] = static_cast<int>(values[m + 2]);
}

// In a step of `restart N` the host has stored histories before the forces: its file would heal the
// bonds that broke in that step and lose the step's increments. Stored again, it is the file of
// write_restart.
void FixBondBpm::end_of_step() {
  if (neighbor->ago != 0 || !output->restart_requested(update->ntimestep))
    return; // such a step always rebuilds the lists
  PairGran *pair = static_cast<PairGran *>(force->pair_match("gran", 1));
  store_histories();
  if (pair && pair->get_fix_history())
    pair->get_fix_history()->pre_exchange();
}

void FixBondBpm::write_restart(FILE *fp) {
  gather_breaks();
  if (comm->me != 0)
    return;
  std::vector<double> record(kHeader);
  record[0] = created_;
  record[1] = static_cast<double>(initial_);
  record[2] = energy_lost_;
  record[3] = static_cast<double>(breaks_.size());
  for (int m = 1; m <= 4; ++m)
    record[3 + m] = static_cast<double>(by_mode_[m]);
  for (int k = 0; k < calendem::kBridgeKinds; ++k) {
    record[8 + k] = static_cast<double>(bridges_made_[k]);
    record[11 + k] = static_cast<double>(bridges_broken_[k]);
  }
  record[14] = bridge_energy_lost_;
  record[15] = shrunk_;
  for (size_t k = 0; k < earlier_.size(); ++k)
    record[16 + k] = remembered()[k].value;
  record[21] = bodies_;
  record[22] = largest_radius_;
  const double *events = reinterpret_cast<const double *>(breaks_.data());
  record.insert(record.end(), events, events + kEventSize * breaks_.size());
  const int bytes = static_cast<int>(record.size() * sizeof(double));
  fwrite(&bytes, sizeof(int), 1, fp);
  fwrite(record.data(), sizeof(double), record.size(), fp);
}

void FixBondBpm::restart(char *buf) {
  const double *record = reinterpret_cast<const double *>(buf);
  created_ = restarted_ = record[0] != 0.0;
  initial_ = static_cast<bigint>(record[1]);
  energy_lost_ = record[2];
  breaks_.resize(static_cast<size_t>(record[3]));
  for (int m = 1; m <= 4; ++m)
    by_mode_[m] = static_cast<bigint>(record[3 + m]);
  for (int k = 0; k < calendem::kBridgeKinds; ++k) {
    bridges_made_[k] = static_cast<bigint>(record[8 + k]);
    bridges_broken_[k] = static_cast<bigint>(record[11 + k]);
  }
  bridge_energy_lost_ = record[14];
  shrunk_ = record[15];
  std::copy_n(record + 16, earlier_.size(), earlier_.begin());
  bodies_ = static_cast<int>(record[21]);
  largest_radius_ = record[22];
  memcpy(breaks_.data(), record + kHeader, breaks_.size() * sizeof(BreakEvent));
}

// What pairs keep in their histories follows from these.
std::array<FixBondBpm::Remembered, 5> FixBondBpm::remembered() const {
  return {{{"contact_diameter", settings_.contact_diameter},
           {"surface_inset", settings_.surface_inset},
           {"inset_fading", settings_.inset_fading},
           {"shrinkage", shrinkage_.strain},
           {"shrinkage's time", shrinkage_.time}}};
}

void FixBondBpm::check_remembered() {
  for (size_t k = 0; k < earlier_.size(); ++k) {
    const Remembered now = remembered()[k];
    char message[300];
    snprintf(message, sizeof message,
             "%s is %g, and the run that goes on from this restart file began with %g: it must "
             "stay as it was. Give %.10g, or begin the run anew",
             now.name, now.value, earlier_[k], earlier_[k]);
    if (restarted_ && std::fabs(now.value - earlier_[k]) > 1e-9 * earlier_[k])
      error->fix_error(FLERR, this, message);
  }
}

double FixBondBpm::memory_usage() {
  return 2.0 * atom->nmax * sizeof(int) + breaks_.capacity() * sizeof(BreakEvent);
}
