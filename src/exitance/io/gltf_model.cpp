#include "exitance/io/gltf_model.hpp"

#include <algorithm>

namespace exitance {

std::size_t GltfRows::bytes(Number number) {
    switch (number) {
        case Number::int8:
        case Number::uint8:
            return 1;
        case Number::int16:
        case Number::uint16:
            return 2;
        default:
            return 4;
    }
}

double GltfRows::at(std::size_t row, std::size_t k) const {
    switch (number_) {
        case Number::float32:
            return static_cast<double>(value<float>(row, k));
        case Number::uint32:
            return value<std::uint32_t>(row, k);
        case Number::int16: {
            const double v = value<std::int16_t>(row, k);
            return normalized_ ? std::max(v / 32767, -1.0) : v;
        }
        case Number::uint16:
            return value<std::uint16_t>(row, k) / (normalized_ ? 65535.0 : 1.0);
        case Number::int8: {
            const double v = value<std::int8_t>(row, k);
            return normalized_ ? std::max(v / 127, -1.0) : v;
        }
        case Number::uint8:
            return value<std::uint8_t>(row, k) / (normalized_ ? 255.0 : 1.0);
    }
    return 0;
}

std::uint32_t GltfRows::index(std::size_t row) const {
    switch (number_) {
        case Number::uint8:
            return value<std::uint8_t>(row, 0);
        case Number::uint16:
            return value<std::uint16_t>(row, 0);
        default:
            return value<std::uint32_t>(row, 0);
    }
}

}  // namespace exitance
