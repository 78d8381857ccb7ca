#pragma once

#include <cstdint>

namespace exitance {

/// By what links are held to be good enough.
enum class LinkOracle : std::uint8_t {
    transport,    ///< The error of what they bring.
    form_factor,  ///< The larger of F_pq and F_qp. Source: [Hanrahan91].
    power,        ///< What they bring, F_pq b_q w_p A_p (BF). Source: [Hanrahan91].
};

}  // namespace exitance
