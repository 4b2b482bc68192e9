// SPDX-License-Identifier: GPL-2.0-or-later
#include "fix_wall_gran_platen.h"
#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "fix_property_atom.h"
#include "fix_time_bpm.h"
#include "granular_sliding_wall.h"
#include "modify.h"
#include "physics/fixed_point.h"
#include "primitive_wall.h"
#include "stop_run.h"
#include "update.h"
#include "words.h"
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <utility>

using namespace LAMMPS_NS;
using namespace FixConst;
using calendem::PlatenControl;
using calendem::PlatenStage;

namespace {
char store_force_word[] = "store_force";
char yes_word[] = "yes";
} // namespace

PlatenArguments::PlatenArguments(int narg, char **arg) {
  int i = 0;
  for (; i < narg && strcmp(arg[i], "side") != 0; ++i) {
    if (!strcmp(arg[i], "primitive"))
      host_.insert(host_.end(), {store_force_word, yes_word});
    host_.push_back(arg[i]);
  }
  for (; i < narg; ++i)
    own_.push_back(arg[i]);
}

FixWallGranPlaten::FixWallGranPlaten(LAMMPS *lmp, int narg, char **arg)
    : PlatenArguments(narg, arg), FixWallGran(lmp, static_cast<int>(host_.size()), host_.data()),
      sign_(-1.0), window_(0.25), may_release_(true), moved_(false), sliding_(0.0),
      memory_offset_(-1) {
  const char *z = NULL;
  for (size_t i = 0; i + 1 < host_.size(); ++i)
    if (!strcmp(host_[i], "zplane"))
      z = host_[i + 1];
  if (is_mesh_wall() || !z)
    error->fix_error(FLERR, this, "needs 'primitive type T zplane Z'");
  if (!domain->periodicity[0] || !domain->periodicity[1] || domain->periodicity[2])
    error->fix_error(FLERR, this, "needs 'boundary p p f': periodic in x and y, walls in z");
  programme_.start = record_.state.position = NumberReader(error, this)("zplane", z, kAnyNumber);
  programme_.lowest = domain->boxlo[2];
  parse();
  set_window();
  if (slides())
    impl = new SlidingWall(impl, sliding_);
  vector_flag = 1;
  size_vector = 15;
  global_freq = 1;
  restart_global = 1;
}

bool FixWallGranPlaten::set_roll_keyword(const std::string &key, const std::string &value) {
  const NumberReader number(error, this);
  if (key == "roll") {
    programme_.control = PlatenControl::Roll;
    programme_.target = number(key, value, kPositive);
  } else if (key == "roll_radius")
    programme_.roll.radius = number(key, value, kPositive);
  else if (key == "counter_radius")
    programme_.roll.counter = number(key, value, kNotNegative);
  else if (key == "slip")
    programme_.roll.slip = number(key, value, kNotNegative);
  else if (key == "passes")
    programme_.passes = number(key, value, whole_between(1, 1e6));
  else if (key == "first")
    programme_.first_target = number(key, value, kNotNegative);
  else if (key == "spacing" && (value == "step" || value == "ratio"))
    programme_.by_ratio = value == "ratio";
  else
    return false;
  return true;
}

bool FixWallGranPlaten::set_bridges(const std::string &key, const std::string &value) {
  if (key != "bridges" || (value != "yes" && value != "no"))
    return false;
  if (value == "yes")
    bridges_.reset(new WallBridges(lmp, id, programme_.start));
  return true;
}

bool FixWallGranPlaten::set_number(const std::string &key, const std::string &value) {
  const std::map<std::string, std::pair<double *, NumberRange>> numbers = {
      {"touch_speed", {&programme_.touch_speed, kPositive}},
      {"load_speed", {&programme_.load_speed, kPositive}},
      {"release_speed", {&programme_.release_speed, kPositive}},
      {"touch_pressure", {&programme_.touch_pressure, kNotNegative}},
      {"dwell", {&programme_.dwell, kNotNegative}},
      {"wait", {&programme_.wait, kNotNegative}},
      {"ramp", {&programme_.ramp_time, kNotNegative}},
      {"lost", {&programme_.lost_fraction, kNotNegative}},
      {"lowest", {&programme_.lowest, kNotNegative}},
      {"compliance", {&programme_.compliance, kNotNegative}},
      {"average", {&window_, kPositive}}};
  const auto number = numbers.find(key);
  if (number == numbers.end())
    return false;
  *number->second.first = NumberReader(error, this)(key, value, number->second.second);
  return true;
}

void FixWallGranPlaten::set_keyword(const std::string &key, const std::string &value) {
  if (set_roll_keyword(key, value) || set_bridges(key, value) || set_number(key, value))
    return;
  if (key == "side" && (value == "top" || value == "bottom"))
    sign_ = value == "top" ? -1.0 : 1.0;
  else if (key == "motion" && value == "hold")
    programme_.control = PlatenControl::Hold;
  else if (key == "pressure" || key == "position") {
    programme_.control = key == "pressure" ? PlatenControl::Pressure : PlatenControl::Position;
    programme_.target = NumberReader(error, this)(key, value, kPositive);
  } else if (key == "release" && (value == "yes" || value == "no"))
    may_release_ = value == "yes";
  else {
    const std::string message =
        "unknown setting '" + key + " " + value +
        "'; known: side top|bottom, motion hold | motion pressure P | motion position Z | "
        "motion roll GAP, roll_radius, counter_radius, slip, first, spacing step|ratio, passes, "
        "touch_speed, load_speed, release_speed, touch_pressure, wait, dwell, ramp, lost, lowest, "
        "average, compliance, release yes|no, bridges yes|no";
    error->fix_error(FLERR, this, message.c_str());
  }
}

void FixWallGranPlaten::parse() {
  for (size_t i = 0; i < own_.size();) {
    const bool motion = own_[i] == "motion" && i + 1 < own_.size() && own_[i + 1] != "hold";
    const size_t key = motion ? i + 1 : i; // 'motion pressure P' is the setting 'pressure P'
    if (key + 1 >= own_.size()) {
      const std::string message = "keyword '" + own_[key] + "' lacks its value";
      error->fix_error(FLERR, this, message.c_str());
    }
    set_keyword(own_[key], own_[key + 1]);
    i = key + 2;
  }
  if (programme_.control == PlatenControl::Hold)
    return;
  if (bridges_)
    error->fix_error(FLERR, this, "'bridges yes' is for walls at rest, 'motion hold'");
  if (programme_.load_speed <= 0.0 || programme_.touch_speed <= 0.0 ||
      programme_.release_speed <= 0.0)
    error->fix_error(FLERR, this,
                     "a moving platen needs 'touch_speed', 'load_speed' and 'release_speed' > 0");
  if (programme_.lost_fraction >= 1.0)
    error->fix_error(FLERR, this, "'lost' is a fraction of the maximum pressure, below 1");
  if (programme_.control == PlatenControl::Pressure && !strcmp(update->unit_style, "micro") &&
      programme_.target > 1e8)
    error->fix_error(
        FLERR, this,
        "'pressure' is more than 100 GPa (units micro: 1 is 1 kPa). Is it given in Pa? "
        "The input scripts take MPa");
  if (programme_.control == PlatenControl::Roll)
    check_roll();
  else if (programme_.first_target > 0.0 && (programme_.control != PlatenControl::Pressure ||
                                             programme_.first_target > programme_.target))
    error->fix_error(FLERR, this,
                     "'first' is the pressure of the first of several passes, at most that of the "
                     "last ('pressure'); 0: the same in all");
  if (programme_.control != PlatenControl::Pressure && programme_.target >= programme_.start)
    error->fix_error(FLERR, this,
                     "the target position must lie below the start ('zplane'); nothing would be "
                     "compressed");
  enter(record_.state, PlatenStage::Compression, 0.0);
}

void FixWallGranPlaten::check_roll() {
  if (programme_.roll.radius <= 0.0)
    error->fix_error(FLERR, this, "'motion roll' needs 'roll_radius' > 0");
  if (programme_.first_target > 0.0 &&
      (programme_.first_target < programme_.target || programme_.first_target >= programme_.start))
    error->fix_error(FLERR, this,
                     "'first' must lie between the roll's gap and the start ('zplane'), or be "
                     "0: the gap of the last pass");
  if (programme_.compliance > 0.0)
    error->fix_error(
        FLERR, this,
        "the gap of 'motion roll' is that of the loaded rolls: 'compliance' must be 0");
}

bool FixWallGranPlaten::slides() const {
  const calendem::RollNip &roll = programme_.roll;
  return programme_.control == PlatenControl::Roll &&
         (roll.slip > 0.0 || roll.radius != roll.counter);
}

int FixWallGranPlaten::setmask() { return FixWallGran::setmask() | INITIAL_INTEGRATE; }

void FixWallGranPlaten::post_create() {
  FixWallGran::post_create();
  time_ = FixTimeBpm::of(lmp);
  time_->claim_state(this);
  if (bridges_)
    bridges_->add_storage(style);
}

void FixWallGranPlaten::pre_delete(bool unfix) {
  FixWallGran::pre_delete(unfix);
  if (unfix && bridges_)
    bridges_->delete_storage();
}

void FixWallGranPlaten::init() {
  time_->stop_if_state_is_lost(this);
  FixWallGran::init();
  if (bridges_)
    bridges_->init(modify->find_fix(id));
  set_window();
  memory_offset_ = get_history_offset("contact_effects");
  shear_ = 1;
  shearDim_ = 2;
  shearAxis_ = -1;
  place_wall();
}

void FixWallGranPlaten::set_window() {
  record_.average.set_window(window_ / update->dt);
  record_.height.set_window(window_ / update->dt);
}

std::vector<FixWallGranPlaten *> FixWallGranPlaten::all(const Modify &modify) {
  std::vector<FixWallGranPlaten *> out;
  for (int k = 0; k < modify.nfix; ++k)
    if (FixWallGranPlaten *wall = dynamic_cast<FixWallGranPlaten *>(modify.fix[k]))
      out.push_back(wall);
  return out;
}

calendem::WallContact FixWallGranPlaten::contact(int i) const {
  return {atom->x[i][2] - position(), atom->radius[i]};
}

double FixWallGranPlaten::mean_position() const {
  return record_.height.empty() ? record_.state.position : record_.height.value();
}

void FixWallGranPlaten::place_wall() {
  double z = record_.state.position;
  delete primitiveWall_;
  primitiveWall_ = new PrimitiveWall(lmp, PRIMITIVE_WALL_DEFINITIONS::ZPLANE, 1, &z);
  vshear_ = -record_.state.speed;
  sliding_ = slip_speed(programme_, record_.state);
  moved_ = true;
}

void FixWallGranPlaten::initial_integrate(int) {
  if (programme_.control == PlatenControl::Hold)
    return;
  const double dt = update->dt;
  const double z = record_.state.position;
  advance(programme_, record_.state, record_.average.value(), window_, time_->now(), dt,
          may_release_);
  // half of the step's work with the load at its beginning, the other half in measure()
  record_.work += 0.5 * record_.load.value() * (z - record_.state.position);
  place_wall();
  record_.work += 0.5 * record_.drag * sliding_ * dt;
}

void FixWallGranPlaten::setup_pre_force(int) {
  if (bridges_)
    bridges_->note_creation();
}

void FixWallGranPlaten::setup(int vflag) {
  if (bridges_)
    bridges_->create(atom_type_wall());
  FixWallGran::setup(vflag);
}

void FixWallGranPlaten::pre_force(int vflag) {
  rebuildPrimitiveNeighlist_ = rebuildPrimitiveNeighlist_ || moved_;
  moved_ = false;
  FixWallGran::pre_force(vflag);
}

const double *FixWallGranPlaten::effect_memory(int i) const {
  return memory_offset_ < 0 ? NULL : fix_history_primitive_->array_atom[i] + memory_offset_;
}

double FixWallGranPlaten::area() const { return domain->xprd * domain->yprd; }

void FixWallGranPlaten::post_force(int vflag) {
  FixWallGran::post_force(vflag);
  if (bridges_)
    bridges_->act(!update->setupflag);
  if (update->setupflag)
    return;
  measure();
  if (slides())
    measure_drag();
}

calendem::WideSum FixWallGranPlaten::over_ranks(const calendem::WideSum &sum) const {
  calendem::WideSum all;
  MPI_Allreduce(sum.whole, all.whole, calendem::WideSum::kWeights + 1, MPI_LONG_LONG, MPI_SUM,
                world);
  return all;
}

calendem::WideSum FixWallGranPlaten::load_of_rank() const {
  calendem::WideSum load;
  for (int i = 0; i < atom->nlocal; ++i)
    load.add(sign_ * fix_wallforce_->array_atom[i][2]);
  for (int i = 0; bridges_ && i < atom->nlocal; ++i)
    load.add(sign_ * bridges_->force(i));
  if (!load.holds_all())
    stop_run(lmp, FLERR,
             "a particle presses fix wall/gran/platen with a force that is not a number. The time "
             "step is too large, or something moves too fast: lower the timestep or the speed");
  return load;
}

// Ranks wait for each other only at the end of an average's block. Once the platen has ended, pressure
// and gap stay those at which contact was lost: averages over a platen at rest belong to no one gap.
void FixWallGranPlaten::measure() {
  record_.load = load_of_rank();
  if (stage_of(record_.state) == calendem::PlatenStage::Done)
    return;
  record_.block.add(record_.load);
  record_.work += 0.5 * record_.load.value() * record_.state.speed * update->dt;
  if (!record_.height.add(record_.state.position))
    return;
  const double all = over_ranks(record_.block).value();
  record_.block = {};
  const double steps = record_.height.block_length;
  record_.average.add_block(all / (steps * area()));
  update_slope(programme_, record_.state, record_.average.value(), steps * update->dt);
}

void FixWallGranPlaten::add_up(Record &record) const {
  const double my_work[2] = {record.work, record.drag};
  double work[2];
  MPI_Allreduce(my_work, work, 2, MPI_DOUBLE, MPI_SUM, world);
  record.load = over_ranks(record.load);
  record.block = over_ranks(record.block);
  record.work = work[0];
  record.drag = work[1];
}

void FixWallGranPlaten::measure_drag() {
  record_.drag = 0.0;
  for (int i = 0; i < atom->nlocal; ++i)
    record_.drag += fix_wallforce_->array_atom[i][0];
  record_.work += 0.5 * record_.drag * sliding_ * update->dt;
}

double FixWallGranPlaten::compute_vector(int n) {
  const calendem::PlatenState &s = record_.state;
  const bool waits = stage_of(s) == PlatenStage::Dwell && !may_release_ &&
                     last_pass(programme_, s) && time_->now() - s.stage_start >= programme_.dwell;
  Record whole = record_;
  if (n == 3 || n == 5 || n == 6)
    add_up(whole);
  const double load = whole.load.value();
  const double values[] = {s.stage,
                           s.position,
                           programme_.start - s.position,
                           load,
                           record_.average.value(),
                           load / area(),
                           whole.work,
                           s.speed,
                           s.max_pressure,
                           s.reached,
                           waits ? 1.0 : 0.0,
                           window_,
                           mean_position(),
                           std::fmax(programme_.passes - s.passed - 1.0, 0.0),
                           sliding_};
  return values[n];
}

// The first rank goes on from the sums, as after a restart: both give the same bits.
void FixWallGranPlaten::write_restart(FILE *fp) {
  add_up(record_);
  if (comm->me == 0) {
    const double start = programme_.start;
    const int bytes = static_cast<int>(sizeof(Record) + sizeof start);
    fwrite(&bytes, sizeof(int), 1, fp);
    fwrite(&record_, sizeof(Record), 1, fp);
    fwrite(&start, sizeof start, 1, fp);
  }
  keep_share();
}

void FixWallGranPlaten::restart(char *buf) {
  memcpy(&record_, buf, sizeof(Record));
  memcpy(&programme_.start, buf + sizeof(Record), sizeof programme_.start);
  keep_share();
}

void FixWallGranPlaten::keep_share() {
  if (comm->me != 0) {
    record_.load = record_.block = {};
    record_.work = record_.drag = 0.0;
  }
}
