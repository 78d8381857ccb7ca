#pragma once

#include "exitance/links/links.hpp"
#include "exitance/transport/ray_rows.hpp"

namespace exitance {

/// Links of constant elements, found by rays: every leaf is linked to what its rays hit, each link to the largest
/// element whose light is so even that reading the whole of it is good enough,
///
///     F_iq = share of the rays of leaf i that hit element q first,     F_iq rms_q(b - b_q) rho_i sqrt(A_i) <= allowed.
///
/// Form factor and visibility in one; links to where no light comes from are never evaluated, so that no pair of
/// elements is. What a leaf's links bring differs from what its rays do by no more than the unevenness that was allowed
/// for, and F sums to 1 over the links of a leaf that sees surfaces alone. Source: levels as in [Hanrahan91], form
/// factors as in [Malley88]. O(rays log rays).
///
/// Where several processes work together, each finds the links of its own rows (`RowsHeld::by_owner`), a block of
/// leaves at a time (`dealt_block`).
///
/// sites    of order 1          rows   of all leaves of its tree
/// b        reflected light of all elements, W/m^2
/// allowed  error of one link: root of the receiver's area times the RMS error of the radiosity that it causes, W/m^2 m
Links link_by_rays(const LinkSites& sites, const LeafNumbering& numbering, const RayRows& rows, const NodalField& b,
                   double allowed);

/// The links of all processes, by receiver, then by source; `own`: those that link_by_rays found for this one. All.
std::vector<KeptLink> list_of_all(const Links& own, const LeafNumbering& numbering);

}  // namespace exitance
