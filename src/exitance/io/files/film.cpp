#include "exitance/io/files/film.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "exitance/io/files/child_process.hpp"
#include "exitance/io/files/whole_file.hpp"

namespace exitance {

bool is_film(const std::string& path) {
    const std::array<std::string, 4> endings{".mp4", ".mkv", ".webm", ".gif"};
    return std::find(endings.begin(), endings.end(), ending(path)) != endings.end();
}

Result<void> find_film_program(const std::string& path) {
    if (is_program("ffmpeg")) return {};
    return Error{ErrorCode::cannot_write, "a video is made by ffmpeg, which is not installed", path,
                 "install the package ffmpeg, or write numbered pictures: -o walk.png"};
}

Result<void> write_film(const std::string& folder, double rate, const std::string& path) {
    const auto words_for = [&](const std::string& part) {
        std::vector<std::string> words{"ffmpeg",
                                       "-nostdin",
                                       "-y",
                                       "-loglevel",
                                       "error",
                                       "-framerate",
                                       fmt::format("{:g}", rate),
                                       "-i",
                                       folder + "/frame.%04d.png",
                                       "-vf"};
        // Most players require even sizes and 4:2:0 chroma subsampling. A GIF needs a palette.
        const std::string even = "pad=ceil(iw/2)*2:ceil(ih/2)*2";
        if (ending(path) == ".gif")
            words.push_back(even + ",split[a][b];[a]palettegen[p];[b][p]paletteuse");
        else
            words.insert(words.end(), {even, "-pix_fmt", "yuv420p"});
        words.push_back(part);
        return words;
    };
    const Result<void> made = run_into_file(path, words_for, std::numeric_limits<double>::infinity(), StopRequest());
    if (made) return {};
    return Error{ErrorCode::cannot_write, fmt::format("ffmpeg made no video: {:.200}", made.error().message), path,
                 "numbered pictures, -o walk.png, need no ffmpeg"};
}

}  // namespace exitance
