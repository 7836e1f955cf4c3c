#include "load/contact_model.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/parallel.hpp"

namespace riven {

namespace {

/// Kernels pass over points that no bond holds, and leave there what was: the contact forces of the step
/// before.
void clear(std::span<double> force) {
  parallel_pieces(force.size(), [&](std::size_t begin, std::size_t end) {
    std::fill(force.begin() + static_cast<std::ptrdiff_t>(begin),
              force.begin() + static_cast<std::ptrdiff_t>(end), 0.0);
  });
}

}  // namespace

ContactStiffness contact_stiffness(Model& model, const Body& body) {
  const std::vector<double> rest(model.dofs(), 0.0);
  std::vector<double> bound(model.dofs());
  model.stiffness_bound(rest, bound);
  double per_volume = 0, largest = 0;
  for (const std::size_t i : body.points) {
    largest = std::max(largest, body.volume[i]);
    for (std::size_t d = 0; d < static_cast<std::size_t>(body.dimension); ++d)
      per_volume = std::max(per_volume, bound[d * body.size() + i] / body.volume[i]);
  }
  return {0.25 * per_volume, 0.25 * per_volume / largest};
}

ContactModel::ContactModel(std::unique_ptr<Model> model, const Body& body,
                           std::optional<SelfContactSettings> self, std::vector<Impactor> impactors)
    : model_(std::move(model)), body_(body), self_settings_(self), impactors_(std::move(impactors)) {
  bare_.assign(model_->dofs(), 0.0);
  if (self) self_.emplace(body_, *self);
}

std::size_t ContactModel::dofs() const {
  return impactor_entry(impactors_.size());
}

std::size_t ContactModel::impactor_entry(std::size_t impactor) const {
  return model_->dofs() + impactor * static_cast<std::size_t>(body_.dimension);
}

Point ContactModel::moved(std::size_t impactor, std::span<const double> u) const {
  Point by{};
  std::copy_n(u.begin() + static_cast<std::ptrdiff_t>(impactor_entry(impactor)), body_.dimension, by.begin());
  return by;
}

Point ContactModel::force_on_impactor(std::size_t impactor, std::span<const double> u) const {
  return force_on(impactors_[impactor], moved(impactor, u), body_, u);
}

std::optional<Breakdown> ContactModel::internal_force(std::span<const double> u, std::span<double> force) {
  if (auto breakdown = model_->internal_force(own(u), bare_)) return breakdown;
  add_contact(u, force);
  return std::nullopt;
}

Passage ContactModel::advance(std::span<const double> u, std::span<double> force) {
  Passage passage = model_->advance(own(u), bare_);
  if (passage.broken > 0) add_contact(u, force);
  return passage;
}

/// The forces on the model's entries and those of contacts.
void ContactModel::add_contact(std::span<const double> u, std::span<double> force) {
  clear(force);
  std::copy(bare_.begin(), bare_.end(), force.begin());
  if (self_) self_->add_force(u, force);
  for (std::size_t n = 0; n < impactors_.size(); ++n) {
    const Point on = push(impactors_[n], moved(n, u), body_, u, force);
    std::copy_n(on.begin(), body_.dimension, force.begin() + static_cast<std::ptrdiff_t>(impactor_entry(n)));
  }
}

double ContactModel::strain_energy(std::span<const double> u) {
  double energy = model_->strain_energy(own(u));
  if (self_) energy += self_->energy(u);
  for (std::size_t n = 0; n < impactors_.size(); ++n)
    energy += contact_energy(impactors_[n], moved(n, u), body_, u);
  return energy;
}

void ContactModel::mass(std::span<double> mass) const {
  model_->mass(mass.first(model_->dofs()));
  for (std::size_t n = 0; n < impactors_.size(); ++n)
    std::fill_n(mass.begin() + static_cast<std::ptrdiff_t>(impactor_entry(n)), body_.dimension,
                impactors_[n].mass.value_or(0));
}

void ContactModel::stiffness_bound(std::span<const double> u, std::span<double> bound) {
  clear(bound);
  model_->stiffness_bound(own(u), bound.first(model_->dofs()));
  if (self_) self_->add_bound(u, bound);
  for (std::size_t n = 0; n < impactors_.size(); ++n) {
    const double row = add_bound(impactors_[n], moved(n, u), body_, u, bound);
    std::fill_n(bound.begin() + static_cast<std::ptrdiff_t>(impactor_entry(n)), body_.dimension, row);
  }
}

Point ContactModel::place(std::size_t entry) const {
  if (entry < model_->dofs()) return model_->place(entry);
  return impactors_[(entry - model_->dofs()) / static_cast<std::size_t>(body_.dimension)].start();
}

std::vector<std::string> ContactModel::describe() const {
  std::vector<std::string> lines = model_->describe();
  if (self_)
    lines.push_back(fmt::format("contact between points without a bond, nearer than {:.4g} m: {:.4g} N/m^7",
                                self_settings_->distance, self_settings_->stiffness));
  for (const Impactor& impactor : impactors_)
    lines.push_back(fmt::format(
        "impactor {}: {}, {}, {:.4g} N/m^4", impactor.name,
        std::holds_alternative<RigidPlane>(impactor.shape) ? "plane" : "sphere",
        impactor.mass ? fmt::format("free, {:.4g} kg", *impactor.mass) : std::string("prescribed velocity"),
        impactor.stiffness));
  return lines;
}

}  // namespace riven
