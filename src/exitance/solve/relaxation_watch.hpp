#pragma once

#include "exitance/solve/krylov_vectors.hpp"
#include "exitance/solve/relaxation.hpp"

namespace exitance {

/// Stopping test and report shared by all relaxations.
class RelaxationWatch {
  public:
    RelaxationWatch(const RadiositySystem& system, StopRule stop)
        : vectors(KrylovVectors{system.F.dealt(), system.area}), stop_(stop), scale_(vectors.norm(system.rhs)) {}

    /// Records the residual `r` after an application of F. Returns true if the relaxation should stop.
    bool done(std::span<const Spectrum> r) { return done(vectors.norm(r)); }
    bool done(double residual_norm) {
        report.residual = scale_ > 0 ? residual_norm / scale_ : 0;
        report.converged = report.residual <= stop_.residual;
        report.interrupted = !report.converged && stop_.request && stop_.request->requested();
        return report.converged || report.interrupted || report.iterations >= stop_.max_iterations;
    }

    const KrylovVectors vectors;
    SolveReport report;

  private:
    StopRule stop_;
    double scale_;
};

}  // namespace exitance
