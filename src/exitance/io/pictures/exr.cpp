#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <exception>
#include <vector>

#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/pictures/linear_image.hpp"

namespace exitance {
namespace {

/// A file in memory, which is then written to disk as a whole.
class MemoryFile : public Imf::OStream {
  public:
    MemoryFile() : OStream("") {}
    void write(const char c[], int n) override {
        const auto end = position_ + static_cast<std::size_t>(n);
        if (content.size() < end) content.resize(end);
        content.replace(position_, static_cast<std::size_t>(n), c, static_cast<std::size_t>(n));
        position_ = end;
    }
    std::uint64_t tellp() override { return position_; }
    void seekp(std::uint64_t position) override { position_ = position; }

    std::string content;

  private:
    std::size_t position_ = 0;
};

std::vector<Imath::half> to_half(const std::vector<float>& values) {
    std::vector<Imath::half> out(values.size());
    std::transform(values.begin(), values.end(), out.begin(),
                   [](float value) { return Imath::half(std::min(value, 65504.0f)); });
    return out;
}

}  // namespace

Result<void> write_exr(const std::string& path, const LinearImage& image, const ImageFacts& facts,
                       Precision precision) {
    try {
        const bool half = precision == Precision::half;
        const Imf::PixelType type = half ? Imf::HALF : Imf::FLOAT;
        const std::size_t bytes = half ? sizeof(Imath::half) : sizeof(float);
        std::vector<std::vector<Imath::half>> halves;
        Imf::Header header(image.width, image.height);
        header.compression() = Imf::ZIP_COMPRESSION;
        Imf::addChromaticities(header, Imf::Chromaticities());  // Rec. 709, white D65
        for (const auto& [name, text] : facts) header.insert(name, Imf::StringAttribute(text));
        Imf::FrameBuffer frame;
        for (const LinearImage::Channel& channel : image.channels) {
            header.channels().insert(channel.name, Imf::Channel(type));
            if (half) halves.push_back(to_half(channel.values));
            const void* values =
                half ? static_cast<const void*>(halves.back().data()) : static_cast<const void*>(channel.values.data());
            // OpenEXR only reads the values, but requires a pointer to non-const
            char* first = static_cast<char*>(const_cast<void*>(values));
            frame.insert(channel.name, Imf::Slice(type, first, bytes, bytes * static_cast<std::size_t>(image.width)));
        }
        MemoryFile memory;
        {
            Imf::OutputFile file(memory, header);
            file.setFrameBuffer(frame);
            file.writePixels(image.height);
        }
        return write_file(path, memory.content);
    } catch (const std::exception& error) {
        return Error{ErrorCode::cannot_write, std::string("the picture cannot be encoded as EXR: ") + error.what(),
                     path, ""};
    }
}

}  // namespace exitance
