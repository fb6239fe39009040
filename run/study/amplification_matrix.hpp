#pragma once

// The study's own theory of time integration, from the published formulas: what measured runs are held
// against.

#include "gcpdda/model/scene.hpp"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace gcpdda::study {

/// A member of the family as a scene names it.
struct Member {
  std::string scheme = "generalized-alpha";
  std::string contact_time = "leapfrog";                  ///< of generalized-alpha, else empty
  double spectral_radius = RunSettings{}.spectral_radius; ///< of both generalized-alpha kinds, else 0

  /// Lines of [run].
  [[nodiscard]] std::string run_keys() const;
};

/// All schemes, each with every contact time and spectral radius it knows.
std::vector<Member> all_members();

/// Where a linear system takes its elastic force.
enum class Elastic { implicit, at_trial };

/// A linear system in units of the step: dt^2 M^-1 K of contacts and of blocks, dt M^-1 C of dashpots.
struct LinearSystem {
  Eigen::MatrixXd contact;
  Eigen::MatrixXd dashpot;
  Eigen::MatrixXd elastic;
};

/// The map of (q, dt q', dt^2 q'') over one step.
Eigen::MatrixXd amplification_matrix(const Member &member, const LinearSystem &system,
                                     Elastic elastic = Elastic::implicit);

/// Growth per step of one contact spring, W = omega dt, with a dashpot of ratio xi.
double oscillator_growth(const Member &member, double w, double damping_ratio = 0.0);

/// Largest W up to which none amplifies; 0 if every W does.
double oscillator_limit(const Member &member, double damping_ratio = 0.0);

} // namespace gcpdda::study
