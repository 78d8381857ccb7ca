#include <fmt/format.h>

#include <cmath>

#include "exitance/cli/verbs.hpp"
#include "exitance/core/parallel.hpp"
#include "exitance/io/display.hpp"
#include "exitance/io/solution_file.hpp"
#include "exitance/io/whole_file.hpp"

namespace exitance {
namespace {

std::string describe(const Camera& c) {
    return fmt::format("{:.4g},{:.4g},{:.4g} {:.4g},{:.4g},{:.4g} {:.4g}", c.eye.x, c.eye.y, c.eye.z, c.target.x,
                       c.target.y, c.target.z, c.fov);
}

/// The picture for people, and the words that go with it.
Image develop(const RenderArguments& arguments, const Solution& solution, const Picture& picture,
              const std::vector<bool>& edges, ImageTexts& texts) {
    if (arguments.false_colour) {
        const ColourScale scale = make_colour_scale(picture, *arguments.false_colour);
        Image image = false_colour_image(picture, *arguments.false_colour, scale);
        draw_edges(image, edges);
        draw_legend(image, *arguments.false_colour, scale);
        return image;
    }
    ToneMap tones = make_tone_map(solution);
    tones.scale *= std::exp2(arguments.exposure);
    texts.emplace_back("Exposure",
                       fmt::format("{:+.4g} stops; radiosity times {:.6g}, then Reinhard's curve with white at {:.4g}",
                                   arguments.exposure, tones.scale, tones.white));
    Image image = display_image(picture, tones);
    draw_edges(image, edges);
    return image;
}

}  // namespace

/// exitance render SOLUTION -o PICTURE
ExitCode run(const RenderArguments& arguments, Terminal& terminal) {
    if (const std::string end = ending(arguments.output); end != ".png")
        return terminal.fail({ErrorCode::usage, fmt::format("pictures are written as .png, not '{}'", end),
                              arguments.output, "name the output something.png"});
    set_threads(arguments.threads);
    const Result<Solution> solution = load_solution(arguments.solution);
    if (!solution) return terminal.fail(solution.error());

    const RadiosityFunction light(*solution);
    const RayTracer tracer(solution->scene);
    const Camera camera =
        arguments.camera ? *arguments.camera : automatic_camera(solution->scene, tracer, arguments.size);
    if (!arguments.camera) terminal.note(fmt::format("--camera '{}'", describe(camera)));
    const Picture picture = take_picture(solution->scene, light, tracer, camera, arguments.size,
                                         static_cast<int>(arguments.samples));
    ImageTexts texts{{"Software", "exitance"}, {"Camera", describe(camera)}};
    std::vector<bool> edges;
    if (arguments.mesh) edges = element_edges(*solution, tracer, camera, arguments.size);
    const Image image = develop(arguments, *solution, picture, edges, texts);
    const Result<void> written = write_png(arguments.output, image, texts);
    return written ? ExitCode::done : terminal.fail(written.error());
}

}  // namespace exitance
