#include "exitance/picture.hpp"

#include <fmt/format.h>

#include <cmath>

#include "exitance/api/inside.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/pictures/display.hpp"
#include "exitance/io/pictures/linear_image.hpp"
#include "exitance/measure/pictures/automatic_camera.hpp"
#include "exitance/measure/pictures/picture.hpp"
#include "exitance/scene/photometric_units.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance::api {

struct PictureData {
    exitance::Picture picture;
    Camera camera;
    LightUnit unit;  ///< Unit of the scene's light.
};

namespace {

constexpr int max_pixels_a_side = 16384, max_samples = 1 << 16;

static_assert(static_cast<int>(Projection::panorama) == static_cast<int>(exitance::Projection::panorama));

exitance::Camera engine_camera(const Camera& c) {
    return {to_engine(c.eye), to_engine(c.target), c.fov, to_engine(c.up),
            static_cast<exitance::Projection>(c.projection)};
}

Camera api_camera(const exitance::Camera& c) {
    return {to_api(c.eye), to_api(c.target), c.fov, to_api(c.up), static_cast<Projection>(c.projection)};
}

/// The error of options out of range; none if all are within.
std::optional<Error> find_misuse(const PictureOptions& o) {
    for (const int side : {o.width, o.height})
        if (side < 1 || side > max_pixels_a_side)
            return usage(fmt::format("{} is not from 1 to {} pixels", side, max_pixels_a_side), "size");
    if (o.samples < 1 || o.samples > max_samples)
        return usage(fmt::format("{} is not from 1 to {} rays per pixel", o.samples, max_samples), "samples");
    if (o.camera)
        if (const Result<void> checked = check_camera(*o.camera); !checked) return checked.error();
    return std::nullopt;
}

/// Copies one quantity of every pixel. Band b of the file's channels is band b of the light.
template <class Value>
std::vector<std::array<float, bands>> values_of(const exitance::Picture& picture, const Value& value) {
    std::vector<std::array<float, bands>> out(picture.pixels.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        const exitance::Spectrum light = value(picture.pixels[i]);
        for (std::size_t b = 0; b < bands; ++b) out[i][b] = static_cast<float>(light[b]);
    }
    return out;
}

Image display_of(const exitance::Picture& picture, double exposure) {
    ToneMap tones;
    tones.curve = ToneCurve::filmic;
    tones.scale = automatic_exposure(picture) * std::exp2(exposure);
    return display_image(picture, tones);
}

Result<void> write(const PictureData& data, const std::string& path, double exposure) {
    const std::string end = ending(path);
    if (end == ".png") return to_api(write_png(path, display_of(data.picture, exposure), {{"Software", "exitance"}}));
    if (end != ".exr" && end != ".hdr")
        return usage(fmt::format("pictures are written as .png, .exr or .hdr, not '{}'", end), path,
                     "name the output something.png");
    const ImageFacts facts{{"software", "exitance"},
                           {"units", fmt::format("R, G, B: radiance in {}; irradiance: {}", data.unit.radiance(),
                                                 data.unit.irradiance())}};
    const LinearImage image = linear_image(data.picture);
    return to_api(end == ".exr" ? write_exr(path, image, facts) : write_hdr(path, image, facts));
}

}  // namespace

Result<void> check_camera(const Camera& camera) {
    if (const std::optional<std::string> fault = find_fault(engine_camera(camera)); fault)
        return usage(*fault, "camera");
    return {};
}

int Picture::width() const {
    return data_->picture.size.width;
}

int Picture::height() const {
    return data_->picture.size.height;
}

const Camera& Picture::camera() const {
    return data_->camera;
}

std::vector<std::array<float, bands>> Picture::radiance() const {
    return values_of(data_->picture,
                     [](const Pixel& p) { return radiance_of_exitance(p.radiosity) * double(p.front); });
}

std::vector<std::array<float, bands>> Picture::irradiance() const {
    return values_of(data_->picture, [](const Pixel& p) { return p.irradiance; });
}

std::vector<std::array<std::uint8_t, 3>> Picture::display(double exposure) const {
    const Image image = display_of(data_->picture, exposure);
    std::vector<std::array<std::uint8_t, 3>> out(image.rgb.size() / 3);
    for (std::size_t i = 0; i < image.rgb.size(); ++i) out[i / 3][i % 3] = image.rgb[i];
    return out;
}

Result<void> Picture::save(const std::string& path, double exposure) const {
    return take_turn<void>([&] { return write(*data_, path, exposure); });
}

Result<Picture> render(const Solution& solution, const PictureOptions& options, const Control& control) {
    return take_turn<Picture>(control, [&](Run& run) -> Result<Picture> {
        if (const std::optional<Error> misuse = find_misuse(options)) return *misuse;
        const RadiosityFunction& light = solution.data().light();
        exitance::PictureOptions in;
        in.size = {options.width, options.height};
        in.samples = options.samples;
        in.camera = options.camera ? engine_camera(*options.camera)
                                   : automatic_camera(light.solution(), light.stage().tracer,
                                                      exitance::Projection::perspective, in.size);
        auto data = std::make_shared<PictureData>();
        data->picture = take_picture(light, in, run.progress(), run.stop());
        if (run.stop().requested()) return stopped("rendering");
        data->camera = api_camera(in.camera);
        data->unit = own_unit(light.solution().scene.is_photometric());
        return Picture(std::move(data));
    });
}

}  // namespace exitance::api
