#pragma once

#include <cstdint>

namespace exitance {

/// Criterion by which links are accepted.
enum class LinkOracle : std::uint8_t {
    transport,    ///< Estimated error of the link's contribution.
    form_factor,  ///< The larger of F_pq and F_qp. Source: [Hanrahan91].
    power,        ///< Contribution of the link, F_pq b_q w_p A_p (BF). Source: [Hanrahan91].
};

}  // namespace exitance
