#include "exitance/io/pictures/unit_picture.hpp"

namespace exitance {

Picture in_unit(Picture picture, const LightUnit& unit) {
    for (Pixel& pixel : picture.pixels)
        for (Spectrum* light : {&pixel.radiosity, &pixel.irradiance, &pixel.from_lamps})
            *light = Spectrum(unit(*light));
    return picture;
}

}  // namespace exitance
