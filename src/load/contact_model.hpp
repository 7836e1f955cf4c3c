#pragma once

#include <memory>

#include "load/impactor.hpp"
#include "load/self_contact.hpp"
#include "model/model.hpp"

namespace riven {

/// Stiffness of contacts, unless another one is wanted: that of a point's contact is a quarter of the largest
/// row bound of the model, about what the bonds pull that a point on a face lacks. So a face in contact is
/// about as stiff as the body inside, and steps stay about as long.
struct ContactStiffness {
  double per_volume = 0;  // kappa (N/m^4)
  double per_pair = 0;    // k (N/m^7)
};
/// Of a model at rest.
ContactStiffness contact_stiffness(Model& model, const Body& body);

/// A model with contact: between points of its body that no bond joins, and with rigid impactors. A state
/// has the model's entries, then a displacement (m) for each impactor, one entry per dimension; those of
/// impactors without mass are to be prescribed. Whatever else is asked is the model's to answer.
class ContactModel final : public Model {
 public:
  /// `body`: the model's; `self`: nothing where points without a bond may pass through each other.
  ContactModel(std::unique_ptr<Model> model, const Body& body, std::optional<SelfContactSettings> self,
               std::vector<Impactor> impactors);

  [[nodiscard]] std::size_t dofs() const override;
  [[nodiscard]] std::optional<Breakdown> internal_force(std::span<const double> u,
                                                        std::span<double> force) override;
  void go_on(double dt) override { model_->go_on(dt); }
  void go_back() override { model_->go_back(); }
  [[nodiscard]] Passage advance(std::span<const double> u, std::span<double> force) override;
  [[nodiscard]] double overload(std::span<const double> u) const override { return model_->overload(own(u)); }
  [[nodiscard]] double dissipated_energy() const override { return model_->dissipated_energy(); }
  /// That of the contacts included.
  [[nodiscard]] double strain_energy(std::span<const double> u) override;
  [[nodiscard]] bool conservative() const override { return model_->conservative(); }
  void mass(std::span<double> mass) const override;
  void stiffness_bound(std::span<const double> u, std::span<double> bound) override;
  [[nodiscard]] double spacing() const override { return model_->spacing(); }
  [[nodiscard]] std::optional<Breakdown> inspect(std::span<const double> u) override {
    return model_->inspect(own(u));
  }
  void move(std::span<double> u, const std::array<std::array<double, 3>, 3>& gradient,
            const Point& shift) const override {
    model_->move(u.first(model_->dofs()), gradient, shift);
  }
  [[nodiscard]] std::vector<Point> positions() const override { return model_->positions(); }
  [[nodiscard]] std::vector<Point> displacements(std::span<const double> u) const override {
    return model_->displacements(own(u));
  }
  [[nodiscard]] std::vector<ModelField> fields(std::span<const double> u) override {
    return model_->fields(own(u));
  }
  [[nodiscard]] Point place(std::size_t entry) const override;
  [[nodiscard]] std::string remedies() const override { return model_->remedies(); }
  void save(Snapshot& to) const override { model_->save(to); }
  void restore(const Snapshot& from) override { model_->restore(from); }
  [[nodiscard]] std::vector<std::string> describe() const override;
  [[nodiscard]] std::size_t points() const override { return model_->points(); }
  [[nodiscard]] std::size_t bonds() const override { return model_->bonds(); }
  [[nodiscard]] bool has_memory() const override { return model_->has_memory(); }

  [[nodiscard]] const std::vector<Impactor>& impactors() const { return impactors_; }
  /// First entry of an impactor in a state.
  [[nodiscard]] std::size_t impactor_entry(std::size_t impactor) const;
  /// How far an impactor has moved (m).
  [[nodiscard]] Point moved(std::size_t impactor, std::span<const double> u) const;
  /// Force (N) of the body on an impactor.
  [[nodiscard]] Point force_on_impactor(std::size_t impactor, std::span<const double> u) const;

 private:
  [[nodiscard]] std::span<const double> own(std::span<const double> u) const {
    return u.first(model_->dofs());
  }
  void add_contact(std::span<const double> u, std::span<double> force);

  std::unique_ptr<Model> model_;
  const Body& body_;
  std::optional<SelfContactSettings> self_settings_;
  std::optional<SelfContact> self_;
  std::vector<Impactor> impactors_;
  std::vector<double> bare_;  // forces of the model alone (N)
};

}  // namespace riven
