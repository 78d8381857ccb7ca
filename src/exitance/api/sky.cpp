#include "exitance/api/sky.hpp"

#include "exitance/api/inside.hpp"
#include "exitance/io/files/wea_file.hpp"
#include "exitance/io/scenes/sky_words.hpp"

namespace exitance::api {

Result<std::optional<ChosenSky>> read_sky(const std::string& words, const std::string& epw) {
    if (words.empty()) {
        if (!epw.empty()) return usage("a weather file needs a sky", "epw", "add sky=\"perez,time=06-21T12:00\"");
        return std::optional<ChosenSky>();
    }
    std::optional<Weather> weather;
    if (!epw.empty()) {
        exitance::Result<Weather> read = load_weather(epw);
        if (!read) return to_api(read.error());
        weather = std::move(*read);
    }
    exitance::Result<ChosenSky> sky = parse_sky(words, weather ? &*weather : nullptr);
    if (!sky) return to_api(sky.error());
    if (weather)
        for (const std::string& warning : weather->warnings) sky->warnings.push_back(epw + ": " + warning);
    return std::optional(std::move(*sky));
}

}  // namespace exitance::api
