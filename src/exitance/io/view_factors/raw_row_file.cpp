#include "exitance/io/view_factors/raw_row_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <span>

#include "exitance/base/random.hpp"
#include "exitance/base/version.hpp"

namespace exitance {
namespace {

constexpr std::array<char, 8> magic = {'E', 'X', 'I', 'R', 'O', 'W', 'S', '3'};

/// Header of a record, followed by its entries.
struct RecordHead {
    std::uint64_t checksum;  ///< Hash of the rest of the record.
    std::uint64_t entries, rays, cast_rays;
    std::uint32_t face, round;
    double cast_density, sky, back, sky_variance, back_variance, missed_variance, bound;
};
static_assert(std::is_trivially_copyable_v<RecordHead> && std::is_trivially_copyable_v<RowEntry>);
static_assert(sizeof(RowEntry) == 24, "without gaps, as its bytes are hashed");

std::uint64_t hash_bytes(std::span<const std::byte> bytes, std::uint64_t seed) {
    std::uint64_t sum = hash(seed, bytes.size());
    for (std::size_t k = 0; k < bytes.size(); k += 8) {
        std::uint64_t word = 0;
        std::memcpy(&word, bytes.data() + k, std::min<std::size_t>(8, bytes.size() - k));
        sum = hash(sum ^ word);
    }
    return sum;
}

std::uint64_t checksum_of(const RecordHead& head, std::span<const RowEntry> entries) {
    const auto bytes = std::as_bytes(std::span(&head, 1)).subspan(sizeof head.checksum);
    return hash_bytes(std::as_bytes(entries), hash_bytes(bytes, 0));
}

Error refused(const std::string& path, int error) {
    return {ErrorCode::cannot_write, std::string("cannot be written: ") + std::strerror(error), path, ""};
}

Error not_rows(const std::string& path) {
    return {ErrorCode::bad_input, "is not a file of rows of view factors", path, "remove it"};
}

/// Number of records in a work file, which may be of any scene; 0 if there is no file. Error: it is of another kind.
Result<std::size_t> count_rows(const std::string& path) {
    constexpr auto close = [](std::FILE* file) { std::fclose(file); };
    const std::unique_ptr<std::FILE, decltype(close)> file(std::fopen(path.c_str(), "rb"));
    if (!file) return 0;
    std::array<char, magic.size()> found{};
    const std::size_t bytes = std::fread(found.data(), 1, found.size(), file.get());
    if (bytes == 0) return 0;
    if (bytes < found.size() || !std::equal(found.begin(), found.end() - 1, magic.begin())) return not_rows(path);
    if (found != magic) return 0;  // a file of another version cannot be resumed
    std::fseek(file.get(), sizeof(std::array<std::uint64_t, 2>), SEEK_CUR);
    std::size_t rows = 0;
    for (RecordHead head; std::fread(&head, sizeof head, 1, file.get()) == 1; ++rows) {
        if (head.entries > UINT32_MAX) break;  // damaged
        if (head.entries > 0) {
            RowEntry last;
            const long skipped = static_cast<long>((head.entries - 1) * sizeof last);
            if (std::fseek(file.get(), skipped, SEEK_CUR) != 0 || std::fread(&last, sizeof last, 1, file.get()) != 1)
                break;
        }
    }
    return rows;
}

}  // namespace

long RawRowFile::read_records(std::size_t faces) {
    long whole = std::ftell(file_.get());
    RecordHead head;
    while (std::fread(&head, sizeof head, 1, file_.get()) == 1) {
        if (head.face >= faces || head.entries > faces) break;
        RawRow row;
        row.entries.resize(head.entries);
        if (std::fread(row.entries.data(), sizeof(RowEntry), head.entries, file_.get()) != head.entries) break;
        if (checksum_of(head, row.entries) != head.checksum) break;
        row.face = head.face, row.round = head.round, row.rays = head.rays;
        row.cast_rays = head.cast_rays;
        row.cast_density = head.cast_density, row.bound = head.bound;
        row.sky = head.sky, row.sky_variance = head.sky_variance;
        row.back = head.back, row.back_variance = head.back_variance, row.missed_variance = head.missed_variance;
        resumed_.push_back(std::move(row));
        whole = std::ftell(file_.get());
    }
    return whole;
}

Result<RawRowFile> RawRowFile::open(const std::string& path, const std::string& work, bool resume, std::size_t faces) {
    RawRowFile out;
    out.path_ = path;
    if (!resume) {
        const Result<std::size_t> rows = count_rows(path);
        if (!rows) return rows.error();
        if (*rows > 0 && std::rename(path.c_str(), out.set_aside_path().c_str()) != 0) return refused(path, errno);
        out.set_aside_ = *rows;
    }
    const int descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor < 0) return refused(path, errno);
    out.file_.reset(::fdopen(descriptor, "r+b"));
    if (!out.file_) return refused(path, errno);
    const std::string all = work + " version " + program_version;
    const std::array<std::uint64_t, 2> id = {hash_bytes(std::as_bytes(std::span(all)), 1), all.size()};
    std::FILE* const file = out.file_.get();
    long end = 0;
    if (resume) {
        std::array<char, magic.size()> found_magic;
        std::array<std::uint64_t, 2> found_id;
        const bool any = std::fread(found_magic.data(), found_magic.size(), 1, file) == 1;
        if (any && found_magic != magic) return not_rows(path);
        if (any && std::fread(found_id.data(), sizeof found_id, 1, file) == 1) {
            if (found_id != id)
                return Error{ErrorCode::bad_input, "holds rows of another scene, other options or another program",
                             path, "run with the same options, or without --resume"};
            end = out.read_records(faces);
        }
    }
    if (::ftruncate(descriptor, end) != 0) return refused(path, errno);
    std::fseek(file, end, SEEK_SET);
    if (end == 0) {
        out.failed_ |= std::fwrite(magic.data(), magic.size(), 1, file) != 1;
        out.failed_ |= std::fwrite(id.data(), sizeof id, 1, file) != 1;
    }
    out.flush();
    return out;
}

void RawRowFile::keep(const RawRow& row) {
    if (failed_) return;
    RecordHead head{.checksum = 0,
                    .entries = row.entries.size(),
                    .rays = row.rays,
                    .cast_rays = row.cast_rays,
                    .face = row.face,
                    .round = row.round,
                    .cast_density = row.cast_density,
                    .sky = row.sky,
                    .back = row.back,
                    .sky_variance = row.sky_variance,
                    .back_variance = row.back_variance,
                    .missed_variance = row.missed_variance,
                    .bound = row.bound};
    head.checksum = checksum_of(head, row.entries);
    failed_ |= std::fwrite(&head, sizeof head, 1, file_.get()) != 1;
    failed_ |= std::fwrite(row.entries.data(), sizeof(RowEntry), row.entries.size(), file_.get()) != row.entries.size();
}

void RawRowFile::flush() {
    failed_ |= std::fflush(file_.get()) != 0;
}

void RawRowFile::remove() {
    file_.reset();
    ::unlink(path_.c_str());
    if (set_aside_ > 0) ::unlink(set_aside_path().c_str());
    set_aside_ = 0;
}

void RawRowFile::withdraw() {
    file_.reset();
    ::unlink(path_.c_str());
    if (set_aside_ > 0) std::rename(set_aside_path().c_str(), path_.c_str());
    set_aside_ = 0;
}

}  // namespace exitance
