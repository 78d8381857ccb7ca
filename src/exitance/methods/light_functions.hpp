#pragma once

#include "exitance/reconstruct/solution.hpp"
#include "exitance/solve/global_light.hpp"
#include "exitance/transport/direct_projection.hpp"

namespace exitance {

// What a method found, as functions that rays and files can read.

/// An indirect light of nothing: every piece one element, dark.
ElementFunction dark(const Stage& stage);

/// Light as a method left it on its elements: constant on every leaf.
ElementFunction constant_on_leaves(const GlobalLight& light);

/// What rays read in the local pass, b + c M: on every leaf the direct light that was projected there, and the indirect
/// light that the method found, times the reflectance, and the share c of what it emits (`find_direct_share`). Where
/// the method's own elements agree with that share, E_dir + E_ind is alike all over a leaf but for (1 - c) E_dir.
ElementFunction gathered_light(const Scene& scene, const DirectProjection& direct, const GlobalLight& light,
                               const Spectrum& c);

/// RMS over the surfaces of the standard error of rho E_ind, where a method is a random one, W/m^2.
double rms_standard_error(const Scene& scene, const GlobalLight& light);

}  // namespace exitance
