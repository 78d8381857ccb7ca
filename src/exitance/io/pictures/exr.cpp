#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <exception>

#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/pictures/linear_image.hpp"

namespace exitance {
namespace {

/// A file in memory, so that it can be put into its place at once.
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

}  // namespace

Result<void> write_exr(const std::string& path, const LinearImage& image, const ImageFacts& facts) {
    try {
        Imf::Header header(image.width, image.height);
        header.compression() = Imf::ZIP_COMPRESSION;
        Imf::addChromaticities(header, Imf::Chromaticities());  // Rec. 709, white D65
        for (const auto& [name, text] : facts) header.insert(name, Imf::StringAttribute(text));
        Imf::FrameBuffer frame;
        for (const LinearImage::Channel& channel : image.channels) {
            header.channels().insert(channel.name, Imf::Channel(Imf::FLOAT));
            char* first = const_cast<char*>(reinterpret_cast<const char*>(channel.values.data()));  // it only reads
            frame.insert(channel.name, Imf::Slice(Imf::FLOAT, first, sizeof(float),
                                                  sizeof(float) * static_cast<std::size_t>(image.width)));
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
