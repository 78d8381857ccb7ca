#pragma once

#include <cstdint>

namespace exitance {

/// Criterion by which links are accepted.
enum class LinkOracle : std::uint8_t {
    transport,    ///< Error of their contribution.
    form_factor,  ///< The larger of F_pq and F_qp. Source: [Hanrahan91].
    power,        ///< Their contribution F_pq b_q w_p A_p (BF). Source: [Hanrahan91].
};

}  // namespace exitance
