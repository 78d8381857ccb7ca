#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "exitance/error/batch_mean.hpp"
#include "exitance/error/certificate.hpp"
#include "exitance/error/residual_samples.hpp"

namespace exitance {

/// Weighted sums over the samples of the scene, or of one room.
struct SampleSums {
    double weight = 0;
    std::array<double, batches> squared{};  ///< Squared errors, by batch.
    /// Sums over the samples whose residual is divided into the parts of the local pass and of the method.
    double divided_weight = 0, local = 0, method = 0;
    double rough = 0;  ///< The part of `local` at places where the light varies too much for the elements (RoughPlace).

    /// Adds sample number `k`.
    void add(const ResidualSample& s, double sample_weight, std::size_t k) {
        weight += sample_weight;
        squared[k % batches] += sample_weight * batches * s.squared;
        if (!s.is_divided) return;
        divided_weight += sample_weight;
        local += sample_weight * mean(s.local1 * s.local2);
        method += sample_weight * mean((s.r1 - s.local1) * (s.r2 - s.local2));
    }

    /// Sets the parts of the residual in a certificate, relative to `light`, W/m^2.
    void set_parts(Certificate& out, double light) const {
        const auto part = [&](double sum) { return std::sqrt(std::max(0.0, sum / divided_weight)) / light; };
        out.local = part(local), out.method = part(method), out.rough = part(rough);
    }
};

}  // namespace exitance
