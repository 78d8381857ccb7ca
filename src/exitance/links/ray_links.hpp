#pragma once

#include "exitance/links/links.hpp"
#include "exitance/transport/ray_rows.hpp"

namespace exitance {

/// Makes the links of constant elements from rays. Every leaf is linked to the surfaces that its rays hit. Each link
/// leads to the largest element whose light is uniform enough to be replaced by its mean:
///
///     F_iq = share of the rays of leaf i that hit element q first,     F_iq rms_q(b - b_q) rho_i sqrt(A_i) <= allowed.
///
/// F includes form factor and visibility. Pairs without transport are never evaluated. The light of a leaf's links
/// differs from that of its rays by at most the allowed nonuniformity. F sums to 1 over the links of a leaf whose rays
/// all hit surfaces. Source: levels as in [Hanrahan91], form factors as in [Malley88]. O(rays log rays).
///
/// With several processes, each makes the links of its own rows (`RowsHeld::by_owner`), in blocks of leaves
/// (`dealt_block`).
///
/// sites    of order 1
/// rows     of all leaves of its tree
/// b        reflected light of all elements, W/m^2
/// allowed  error of one link: root of the receiver's area times the RMS error of the radiosity that it causes, W/m^2 m
Links link_by_rays(const LinkSites& sites, const LeafNumbering& numbering, const RayRows& rows, const NodalField& b,
                   double allowed);

/// The links of all processes, sorted by receiver, then by source. `own`: the links that link_by_rays() returned in
/// this process. Collective.
std::vector<KeptLink> list_of_all(const Links& own, const LeafNumbering& numbering);

}  // namespace exitance
