#include <fmt/format.h>

#include <cmath>

#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/lab/peers/peers.hpp"

namespace exitance {
namespace {

/// Factor by which light is divided by its expected maximum: POV-Ray stops light rays below a fixed limit.
double scale(const PeerScene& scene) {
    return 1 / std::max(scene.max_light, 1e-30);
}

/// Size of scenes in POV-Ray's units: it ignores hits closer than a ten-thousandth of a unit.
constexpr double width = 100;

std::string vector_text(Point p) {
    return fmt::format("<{:.9g},{:.9g},{:.9g}>", p.x, p.y, p.z);
}

/// POV-Ray's emission and reflection are shares of one colour. Both sides are equal.
std::string texture_of(const PeerScene::Face& t, double scale) {
    Spectrum colour, emission;
    const bool reflects = max(t.reflectance) > 0;
    for (std::size_t i = 0; i < bands; ++i) {
        colour[i] = reflects ? std::max(t.reflectance[i], 1e-6) : 1;
        emission[i] = scale * t.exitance[i] / colour[i];
    }
    return fmt::format(
        "texture{{pigment{{rgb<{:.9g},{:.9g},{:.9g}>}}finish{{ambient 0 diffuse {} emission "
        "rgb<{:.9g},{:.9g},{:.9g}>}}}}",
        colour[0], colour[1], colour[2], reflects ? 1 : 0, emission[0], emission[1], emission[2]);
}

/// A small triangle around a point. The mesh camera is slightly above it and faces down.
std::string camera_triangle(const ProbePoint& p, double metre) {
    const Frame frame(p.n);
    const double h = 1e-3;
    const Point x = metre * p.x;
    return fmt::format("triangle{{{},{},{}}}\n", vector_text(x - h * frame.u + h * frame.v),
                       vector_text(x + h * frame.u), vector_text(x - h * frame.u - h * frame.v));
}

Result<std::vector<std::string>> prepare_povray(const PeerTask& task) {
    const auto options = named_options(
        task, {{"count", "200"}, {"error_bound", "0.5"}, {"recursion_limit", "8"}, {"nearest_count", "10"}});
    if (!options) return options.error();
    const PeerScene& scene = task.scene;
    const double metre = width / scene.size;
    std::string text = fmt::format(
        "#version 3.7;\nglobal_settings{{assumed_gamma 1 max_trace_level 20 radiosity{{count {} error_bound {} "
        "recursion_limit {} nearest_count {} brightness 1 gray_threshold 0 adc_bailout 0.0001 pretrace_start 0.08 "
        "pretrace_end 0.004 always_sample on}}}}\n",
        options->at("count"), options->at("error_bound"), options->at("recursion_limit"), options->at("nearest_count"));
    for (const PeerScene::Face& face : scene.faces)
        for (const auto& [a, b, c] : face.triangles)
            text += fmt::format("triangle{{{},{},{} {}}}\n", vector_text(metre * face.outline[a]),
                                vector_text(metre * face.outline[b]), vector_text(metre * face.outline[c]),
                                texture_of(face, scale(scene)));
    text += "camera{mesh_camera{1 0 mesh{\n";
    for (const PeerScene::Place& place : scene.places) text += camera_triangle(place.point, metre);
    text += fmt::format("}}}} location<0,0,{:.9g}> direction<0,0,-1>}}\n", 0.01);
    if (const Result<void> written = write_file(task.folder + "/scene.pov", text); !written) return written.error();
    return std::vector<std::string>{"povray",
                                    "+I" + task.folder + "/scene.pov",
                                    "+O" + task.folder + "/light.hdr",
                                    "+FH",
                                    fmt::format("+W{}", scene.places.size()),
                                    "+H1",
                                    fmt::format("+WT{}", task.threads),
                                    "-D",
                                    "-A"};
}

/// Decodes the bytes of a Radiance picture with one line of pixels: red, green, blue and exponent, one channel after
/// the other. Empty if it is damaged. Source: [Ward91], run lengths of 1991.
std::vector<unsigned char> bytes_of_line(std::string_view file, std::size_t width) {
    const std::size_t header = file.find("\n\n");
    const std::size_t begin = header == file.npos ? header : file.find('\n', header + 2);
    if (begin == file.npos) return {};
    std::string_view rest = file.substr(begin + 1);
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(rest[i]); };
    std::vector<unsigned char> out;
    const bool runs = width >= 8 && width < 32768 && rest.size() > 4 && byte(0) == 2 && byte(1) == 2;
    if (!runs) {
        if (rest.size() < 4 * width) return {};
        for (std::size_t channel = 0; channel < 4; ++channel)
            for (std::size_t i = 0; i < width; ++i) out.push_back(byte(4 * i + channel));
        return out;
    }
    for (std::size_t at = 4; out.size() < 4 * width;) {
        const std::size_t count = at < rest.size() ? byte(at) : 0;
        const bool repeats = count > 128;
        const std::size_t stored = repeats ? 1 : count, length = repeats ? count - 128 : count;
        if (length == 0 || at + stored >= rest.size()) return {};
        for (std::size_t i = 0; i < length; ++i) out.push_back(byte(at + 1 + (repeats ? 0 : i)));
        at += 1 + stored;
    }
    return out.size() == 4 * width ? out : std::vector<unsigned char>();
}

Result<PeerLight> read_povray(const PeerTask& task, const ProgramRun&) {
    const std::string path = task.folder + "/light.hdr";
    const Result<std::string> file = read_whole_file(path);
    if (!file) return file.error();
    const std::size_t count = task.scene.places.size();
    const std::vector<unsigned char> bytes = bytes_of_line(*file, count);
    if (bytes.empty()) return Error{ErrorCode::bad_input, fmt::format("is no picture of {} pixels", count), path, ""};
    PeerLight light;
    for (std::size_t i = 0; i < count; ++i) {
        const PeerScene::Place& place = task.scene.places[i];
        Spectrum& irradiance = light.irradiance.emplace_back();
        for (std::size_t band = 0; band < bands && band < 3; ++band) {
            const double shown = std::ldexp(bytes[band * count + i] + 0.5, bytes[3 * count + i] - 136);
            const double radiosity = bytes[3 * count + i] == 0 ? 0 : shown / scale(task.scene);
            const double rho = place.reflectance[band];
            irradiance[band] = rho > 0 ? (radiosity - place.exitance[band]) / rho : 0;
        }
    }
    return light;
}

}  // namespace

const Peer povray_peer{"povray", "povray", prepare_povray, "", read_povray};

}  // namespace exitance
