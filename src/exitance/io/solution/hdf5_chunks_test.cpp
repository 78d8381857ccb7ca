#include "exitance/io/solution/hdf5_chunks.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "support/run.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

constexpr Hdf5Label label = {"1", "made up"};

std::vector<std::byte> noise(std::size_t size) {
    std::vector<std::byte> out(size);
    for (std::size_t i = 0; i < size; ++i) out[i] = static_cast<std::byte>(hash(7, i) & 255);
    return out;
}

TEST(Hdf5Chunks, AreUnpackedAsPacked) {
    for (const std::size_t item_bytes : {1, 2, 4, 8})
        for (const std::size_t items : {1, 7, 1000, 32768})
            for (const bool is_noise : {false, true}) {
                const std::vector<std::byte> chunk =
                    is_noise ? noise(items * item_bytes) : std::vector<std::byte>(items * item_bytes, std::byte{5});
                for (const Hdf5Filters filters : {Hdf5Filters{item_bytes, true}, Hdf5Filters{item_bytes, false}}) {
                    if (!filters.deflates && chunk.size() % 2 != 0) continue;
                    std::vector<std::byte> packed, back(chunk.size());
                    filters.pack(chunk, packed);
                    EXPECT_LE(packed.size(), filters.max_packed(chunk.size()));
                    ASSERT_TRUE(filters.unpack(packed, back));
                    EXPECT_EQ(back, chunk);
                }
            }
}

TEST(Hdf5Chunks, AreNotUnpackedIfAByteOrTheSizeDiffers) {
    const std::vector<std::byte> chunk = noise(4000);
    for (const bool deflates : {false, true}) {
        const Hdf5Filters filters{4, deflates};
        std::vector<std::byte> packed, back(chunk.size());
        filters.pack(chunk, packed);
        std::vector<std::byte> shorter(back.size() - 4), longer(back.size() + 4);
        EXPECT_FALSE(filters.unpack(packed, shorter));
        EXPECT_FALSE(filters.unpack(packed, longer));
        EXPECT_FALSE(filters.unpack(std::span(packed).first(packed.size() - 1), back));
        EXPECT_FALSE(filters.unpack({}, back));
        for (const std::size_t at : {std::size_t{100}, packed.size() - 1}) {
            std::vector<std::byte> damaged = packed;
            damaged[at] ^= std::byte{16};
            EXPECT_FALSE(filters.unpack(damaged, back));
        }
    }
}

/// Writes sets of every type with several chunks each, of compressible and incompressible numbers.
void write_sets(const std::string& path) {
    Hdf5Writer out(path);
    std::vector<std::uint32_t> ids(200001);
    std::vector<float> light(3 * 100001);
    std::vector<std::uint16_t> halves(300001);
    std::vector<double> one_chunk(1000);
    for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = static_cast<std::uint32_t>(i / 3);
    for (std::size_t i = 0; i < light.size(); ++i) light[i] = static_cast<float>(hash(1, i) % 1000003) / 7;
    for (std::size_t i = 0; i < halves.size(); ++i) halves[i] = static_cast<std::uint16_t>(hash(2, i));
    for (std::size_t i = 0; i < one_chunk.size(); ++i) one_chunk[i] = std::sqrt(static_cast<double>(i));
    out.write("ids", ids, 1, label);
    out.write("light", light, 3, label);
    out.write("halves", halves, 1, label);
    out.write("one_chunk", one_chunk, 2, label);
    ASSERT_TRUE(out.commit());
}

TEST(Hdf5Chunks, AgreeWithTheLibrary) {
    const TemporaryFolder folder;
    write_sets(folder / "f.h5");
    Result<Hdf5Reader> in = Hdf5Reader::open(folder / "f.h5");
    ASSERT_TRUE(in) << in.error().message;
    // Numbers of another width are converted and therefore unpacked by the library.
    const auto same = [&](const auto& own, const auto& by_library) {
        return !own.empty() && own.size() == by_library.size() &&
               std::equal(own.begin(), own.end(), by_library.begin(),
                          [](auto a, auto b) { return static_cast<decltype(b)>(a) == b; });
    };
    EXPECT_TRUE(same(in->read<std::uint32_t>("ids"), in->read<std::int64_t>("ids")));
    EXPECT_TRUE(same(in->read<float>("light", 3), in->read<double>("light", 3)));
    EXPECT_TRUE(same(in->read<std::uint16_t>("halves"), in->read<std::int32_t>("halves")));
    EXPECT_EQ(in->read<std::uint32_t>("ids")[200000], 66666u);
    EXPECT_EQ(in->read<double>("one_chunk", 2)[4], 2);
    EXPECT_FALSE(in->failed());
}

TEST(Hdf5Chunks, AreTheSameBytesOnAnyNumberOfThreads) {
    const TemporaryFolder folder;
    std::vector<std::string> files;
    for (const int threads : {1, 3}) {
        set_threads(threads);
        write_sets(folder / "f.h5");
        files.push_back(*read_whole_file(folder / "f.h5"));
    }
    set_threads(0);
    EXPECT_TRUE(files[0] == files[1]);
}

TEST(Hdf5Chunks, AreReportedIfDamaged) {
    const TemporaryFolder folder;
    write_sets(folder / "f.h5");
    const std::string whole = *read_whole_file(folder / "f.h5");
    std::size_t failed = 0;
    constexpr std::size_t places = 40;
    for (std::size_t k = 0; k < places; ++k) {
        std::string damaged = whole;
        damaged[whole.size() / 2 + hash(3, k) % (whole.size() / 4)] ^= 4;  // change a bit of a byte that holds data
        const std::string path = folder / "damaged.h5";
        ASSERT_TRUE(write_file(path, damaged));
        Result<Hdf5Reader> in = Hdf5Reader::open(path);
        if (!in) continue;
        in->read<float>("light", 3), in->read<std::uint16_t>("halves"), in->read<std::uint32_t>("ids");
        failed += in->failed() ? 1 : 0;
    }
    EXPECT_GE(failed, places - 2) << "some bytes may be nobody's";
}

TEST(Hdf5Rows, RowsOfSeveralSetsAreAppendedInAnyPortions) {
    const TemporaryFolder folder;
    constexpr std::size_t rows = 300, columns = 2000;
    std::vector<float> values(rows * columns);
    std::vector<Half> halves;
    for (std::size_t k = 0; k < values.size(); ++k) {
        values[k] = static_cast<float>(k % 3001) / 7;
        halves.push_back(to_half(values[k]));
    }
    {
        Hdf5Writer file(folder / "a.h5");
        Hdf5Rows whole = file.open_rows<float>("whole", rows, columns, label),
                 half = file.open_rows<Half>("half", rows, columns, label),
                 small = file.open_rows<Half>("small", 2, 3, label);
        for (std::size_t row = 0, step = 1; row < rows; row += step, step = std::min(2 * step, rows - row)) {
            file.append(whole, std::span<const float>(values).subspan(row * columns, step * columns));
            file.append(half, std::span<const Half>(halves).subspan(row * columns, step * columns));
        }
        for (const std::size_t row : {0, 1}) file.append(small, std::span<const Half>(halves).subspan(3 * row, 3));
        file.write("at once", values, columns, label);
        ASSERT_TRUE(file.commit());
    }
    Result<Hdf5Reader> read = Hdf5Reader::open(folder / "a.h5");
    ASSERT_TRUE(read);
    EXPECT_EQ(read->read<float>("whole", columns), values);
    EXPECT_EQ(read->read<float>("at once", columns), values);
    // The library's own conversion of 16-bit numbers checks the description of their type.
    const std::vector<float> converted = read->read<float>("half", columns), few = read->read<float>("small", 3);
    ASSERT_EQ(converted.size(), halves.size());
    for (std::size_t k = 0; k < halves.size(); ++k) EXPECT_EQ(converted[k], to_float(halves[k])) << k;
    ASSERT_EQ(few.size(), 6u);
    for (std::size_t k = 0; k < 6; ++k) EXPECT_EQ(few[k], to_float(halves[k])) << k;
}

}  // namespace
}  // namespace exitance
