#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>

#include <exception>
#include <vector>

#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/pictures/read_directional.hpp"

namespace exitance {
namespace {

Result<DirectionalPicture> read_channels(const std::string& path) {
    Imf::InputFile file(path.c_str());
    const Imath::Box2i window = file.header().dataWindow();
    const long long width = static_cast<long long>(window.max.x) - window.min.x + 1,
                    height = static_cast<long long>(window.max.y) - window.min.y + 1;
    if (const Result<void> good = check_directional_size(width, height, path); !good) return good.error();
    const Imf::ChannelList& channels = file.header().channels();
    const bool is_grey = channels.findChannel("R") == nullptr && channels.findChannel("Y") != nullptr;
    std::vector<const char*> names{"R", "G", "B"};
    if (is_grey) names = {"Y"};
    for (const char* name : names)
        if (channels.findChannel(name) == nullptr)
            return Error{ErrorCode::bad_input, std::string("the picture has no channel ") + name, path,
                         "write it with the channels R, G and B"};
    DirectionalPicture out;
    out.width = static_cast<std::size_t>(width), out.height = static_cast<std::size_t>(height);
    std::vector<std::vector<float>> planes;
    for (std::size_t i = 0; i < names.size(); ++i) planes.emplace_back(out.width * out.height);
    Imf::FrameBuffer frame;
    for (std::size_t i = 0; i < names.size(); ++i)
        frame.insert(names[i], Imf::Slice::Make(Imf::FLOAT, planes[i].data(), window));
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
    out.radiance.reserve(out.width * out.height * bands);
    for (std::size_t p = 0; p < out.width * out.height; ++p)
        append_pixel(planes[0][p], planes[is_grey ? 0 : 1][p], planes[is_grey ? 0 : 2][p], out);
    return out;
}

}  // namespace

Result<DirectionalPicture> read_directional_exr(const std::string& path) {
    // OpenEXR's message for a missing file does not give the system's reason.
    if (const Result<std::string> there = read_whole_file(path); !there) return there.error();
    try {
        return read_channels(path);
    } catch (const std::exception& error) {
        return Error{ErrorCode::bad_input, std::string("cannot be read as OpenEXR: ") + error.what(), path,
                     "write the picture again"};
    }
}

}  // namespace exitance
