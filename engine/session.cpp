#include "engine/session.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/catalogue.hpp"
#include "engine/shape_population.hpp"

namespace repose::engine {

namespace {

/// Steps between looks at the stop token, the room and the plausibility of the state.
constexpr std::uint64_t look_every = 64;
/// A step longer than this share of the Rayleigh time is not stable in a dense bed.
constexpr double stable_share = 0.5;
/// A collision must be resolved by at least this many steps.
constexpr double steps_per_impact = 6.0;
/// Overlap over radius beyond which the run is not physics. Soft grains reach 0.2 on hard impact.
constexpr double absurd_overlap = 0.7;

std::string out_of_bounds(std::string_view name, double value, const FieldInfo& field) {
  if (value >= field.lower && value <= field.upper) return {};
  return std::string(name) + " = " + quantity_text(value, field.unit) + " must lie in " +
         quantity_text(field.lower, field.unit) + " to " + quantity_text(field.upper, field.unit);
}

std::string check_parameters(const ParameterSet& parameters) {
  for (const auto& [key, value] : parameters) {
    const ParameterInfo* info = find_parameter(key.field);
    if (info == nullptr) return "there is no parameter " + key.field;
    if (key.between.size() != materials_of(info->scope)) {
      return to_string(key) + " must name " + std::to_string(materials_of(info->scope)) +
             " material(s)";
    }
    if (std::string problem = out_of_bounds(to_string(key), value, *info->field);
        !problem.empty()) {
      return problem;
    }
  }
  for (const std::string_view needed : {"density", "diameter", "shear_modulus", "poisson_ratio"}) {
    const ParameterKey key{std::string(Material::name) + "." + std::string(needed),
                           {MaterialId::grain}};
    if (!parameters.get(key)) return to_string(key) + " must be given";
  }
  for (const std::string_view needed : {"shear_modulus", "poisson_ratio"}) {
    const ParameterKey key{std::string(Material::name) + "." + std::string(needed),
                           {MaterialId::wall}};
    if (!parameters.get(key)) return to_string(key) + " must be given";
  }
  if (std::string problem = check_sizes(parameters); !problem.empty()) return problem;
  return check_shape(parameters);
}

}  // namespace

std::string check(const ExperimentInfo& info, const Trial& trial) {
  if (std::string problem = check_parameters(trial.parameters); !problem.empty()) return problem;
  for (const auto& [name, value] : trial.experiment.settings) {
    const auto field = std::ranges::find(info.settings, name, &FieldInfo::name);
    if (field == info.settings.end()) {
      return "the experiment " + std::string(info.name) + " has no setting " + name;
    }
    if (std::string problem = out_of_bounds(name, value, *field); !problem.empty()) return problem;
  }
  return {};
}

GrainRadii grain_radii(const ParameterSet& parameters) {
  const double diameter = material_of(parameters, MaterialId::grain).diameter;
  const SizePopulation sizes = size_population(parameters);
  const double least = std::cbrt(sizes.smallest);
  const double most = std::cbrt(sizes.largest);
  const auto shape = shape_of_grains(parameters);
  if (!shape) return {0.5 * diameter * least, 0.5 * diameter * most};
  const double scale = diameter / equivalent_diameter(*shape);
  const auto thinnest = std::ranges::min_element(shape->members, {}, &ClumpMember::radius);
  return {scale * thinnest->radius * least, scale * shape->bounding_radius * most};
}

Session::Session(const Trial& trial, const Run& run)
    : trial_(trial),
      run_(run),
      model_(trial.parameters),
      sizes_(size_population(trial.parameters)),
      shape_(shape_of_grains(trial.parameters)),
      radii_(grain_radii(trial.parameters)) {}

double Session::grain_mass() const {
  return unit::pi / 6.0 * std::pow(grain().diameter, 3.0) * grain().density;
}

double Session::impact_time_at(double speed) const {
  const GrainRow least = sphere(radii_.smallest, grain().density);
  const auto time = [&](MaterialId partner, double share) {
    const double modulus = model_.law(partner).elastic.modulus;
    return impact_time(share * mass(least), share * least.radius, modulus, speed);
  };
  return std::min(time(MaterialId::grain, 0.5), time(MaterialId::wall, 1.0));
}

bool Session::set_up(const Apparatus& apparatus) {
  apparatus_ = apparatus;
  const double shortest = impact_time_at(apparatus.fastest);
  const double stable = std::min(stable_share * rayleigh(), shortest / steps_per_impact);
  const double time_step = apparatus.time_step_share * rayleigh();
  if (time_step > stable) {
    return fail(FailureKind::time_step_too_large,
                "time_step of " + short_number(apparatus.time_step_share) +
                    " Rayleigh times is not stable; at most " + short_number(stable / rayleigh()) +
                    " (half the Rayleigh time, and " + short_number(steps_per_impact) +
                    " steps to a collision at " + short_number(apparatus.fastest) + " m/s)");
  }
  world_.emplace(
      model_, WorldOptions{.time_step = time_step, .period = apparatus.period, .team = run_.team});
  world_->change_surfaces() = apparatus.walls;
  return true;
}

GrainRow Session::next_grain() const {
  Random random(trial_.seed, Purpose::grain_size, world_->inserted_grains());
  const double volume = sizes_.volume ? sizes_.volume(random) : 1.0;
  GrainRow row = sphere(0.5 * grain().diameter * std::cbrt(volume), grain().density);
  if (shape_) row.radius *= 2.0 * shape_->bounding_radius / equivalent_diameter(*shape_);
  return row;
}

void Session::put(const GrainRow& grain_row) {
  if (!shape_) {
    world_->add(grain_row);
    return;
  }
  Random random(trial_.seed, Purpose::grain_orientation, world_->inserted_grains());
  world_->add_clump(*shape_,
                    {.density = grain().density,
                     .scale = grain_row.radius / shape_->bounding_radius,
                     .centre = grain_row.centre(),
                     .orientation = random_orientation(random),
                     .velocity = grain_row.velocity(),
                     .spin = grain_row.spin()});
}

bool Session::fail(FailureKind kind, const std::string& message) {
  if (failure_) return false;
  failure_ = Failure{kind, message, world_ ? world_->time() : 0.0};
  emit("failed");  // what it came to
  return false;
}

Outcome outcome_of(const Readings& readings,
                   std::span<const ObservableInfo> observables,
                   const Session& session) {
  if (!readings) return session.failure();
  std::vector<Observation> observations;
  for (std::size_t i = 0; i < observables.size(); ++i) {
    const Reading& reading = (*readings)[i];
    Observation& seen = observations.emplace_back(std::string(observables[i].name));
    seen.value = reading ? *reading : std::numeric_limits<double>::quiet_NaN();
    if (!reading) seen.unread = reading.error();
  }
  if (std::ranges::any_of(observations, &std::string::empty, &Observation::unread)) {
    return observations;
  }
  return Failure{
      FailureKind::not_observed, observations.front().unread, session.effort().simulated_seconds};
}

Failure Session::failure() const {
  return failure_.value_or(Failure{FailureKind::not_observed, "the protocol ended early", 0.0});
}

bool Session::check() {
  if (run_.stop.stop_requested()) return fail(FailureKind::cancelled, "asked to stop");
  const Vec3 low = apparatus_.low;
  const Vec3 high = apparatus_.high;
  left_ += world_->remove([&](const GrainRow& g) {
    // Written so that a coordinate that is no number stays in and is found below.
    return g.x < low.x || g.x > high.x || g.y < low.y || g.y > high.y || g.z < low.z ||
           g.z > high.z;
  });
  if (apparatus_.closed && left_ > 0) {
    return fail(FailureKind::unstable,
                std::to_string(left_) + " grain(s) went through a wall and were lost");
  }
  if (!std::isfinite(world_->kinetic_energy())) {
    return fail(FailureKind::unstable, "a grain's motion is no longer a number");
  }
  const double overlap = world_->largest_overlap();
  largest_overlap_ = std::max(largest_overlap_, overlap);
  if (overlap > absurd_overlap) {
    return fail(FailureKind::unstable,
                "an overlap of " + short_number(overlap) +
                    " radii: the time step is too large or the "
                    "grains are too soft for these speeds");
  }
  return true;
}

bool Session::steps(std::uint64_t count) {
  if (failure_) return false;
  for (std::uint64_t i = 0; i < count; ++i) {
    world_->step();
    if (world_->steps() % look_every == 0 && !check()) return false;
    if (run_.frame_interval > 0.0 && run_.frames && world_->time() >= next_frame_) {
      emit("running");
      next_frame_ += run_.frame_interval;
    }
  }
  return true;
}

std::uint64_t Session::steps_in(double seconds) const {
  return static_cast<std::uint64_t>(std::max(std::llround(seconds / world_->time_step()), 1LL));
}

bool Session::run_for(double seconds) { return steps(steps_in(seconds)); }

bool Session::until(const std::function<bool()>& condition,
                    double watch,
                    double limit,
                    FailureKind kind,
                    const std::string& message) {
  const double start = world_->time();
  while (!condition()) {
    if (world_->time() - start > limit) return fail(kind, message);
    if (!steps(steps_in(watch))) return false;
  }
  return true;
}

bool Session::rest(double limit) {
  return comes_to_rest(limit) ||
         fail(FailureKind::did_not_rest,
              "the grains were still moving after " + short_number(limit) + " s");
}

bool Session::comes_to_rest(double limit) {
  constexpr double hold = 0.05;   // s, experiments' definition of rest
  constexpr double watch = 2e-3;  // s
  const double quiet = 1e-4 * grain_mass() * norm(world_->gravity()) * grain().diameter;
  const double start = world_->time();
  double since = start;
  const auto at_rest = [&] {
    const auto grains = static_cast<double>(std::max<std::size_t>(1, world_->grain_count()));
    if (world_->visible_energy() / grains >= quiet) since = world_->time();
    return world_->time() - since >= hold;
  };
  while (!at_rest()) {
    if (world_->time() - start > limit || !steps(steps_in(watch))) return false;
  }
  overlap_at_rest_ = std::max(overlap_at_rest_, world_->largest_overlap());
  return true;
}

void Session::stage(std::string_view name) {
  if (!failure_) emit(name);
}

void Session::emit(std::string_view stage) {
  if (!run_.frames || !world_) return;
  const Grains& grains = world_->grains();
  const Clumps& clumps = world_->clumps();
  frame_grains_.clear();
  for (std::size_t k = 0; k < grains.size(); ++k) {
    const GrainRow& g = grains.rows[k];
    const std::uint32_t id = grains.ids[k], body = clumps.body_of(id);
    const std::uint32_t first = body == no_body ? id : clumps.bodies()[body].first_id;
    frame_grains_.push_back({g.centre(), g.velocity(), g.radius, id, first});
  }
  std::ranges::sort(frame_grains_, {}, &FrameGrain::id);
  const std::vector<FrameWall> walls = outline(world_->surfaces());
  run_.frames(Frame{.stage = stage,
                    .time = world_->time(),
                    .gravity = world_->gravity(),
                    .period = world_->period(),
                    .grains = frame_grains_,
                    .walls = walls});
}

Effort Session::effort() const {
  if (!world_) return {};
  return {.grains = world_->grain_count(),
          .inserted = world_->inserted_grains(),
          .requested = requested_,
          .steps = world_->steps(),
          .grain_steps = world_->grain_steps(),
          .rebuilds = world_->rebuilds(),
          .time_step = world_->time_step(),
          .simulated_seconds = world_->time(),
          .largest_overlap = largest_overlap_,
          .overlap_at_rest = overlap_at_rest_,
          .contacts = world_->contacts(),
          .bytes_per_grain = world_->bytes_per_grain()};
}

}  // namespace repose::engine
