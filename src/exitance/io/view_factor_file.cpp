#include "exitance/io/view_factor_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace exitance {
namespace {

template <class... Values>
void append(std::string& text, const char* format, Values... values) {
    char buffer[64];
    const int length = std::snprintf(buffer, sizeof buffer, format, values...);
    text.append(buffer, static_cast<std::size_t>(length));
}

Error cannot_write(const std::string& path) {
    return {ErrorCode::cannot_write, "cannot write " + path + ": " + std::strerror(errno), path,
            "check that its folder exists and has room"};
}

/// Written beside the target, flushed to the disk and renamed, so that no reader ever sees half of it.
Result<void> write_whole(const std::string& path, const std::string& content) {
    const std::string beside = path + ".part";
    std::FILE* file = std::fopen(beside.c_str(), "wb");
    if (!file) return cannot_write(path);
    const bool written = std::fwrite(content.data(), 1, content.size(), file) == content.size() &&
                         std::fflush(file) == 0 && fsync(fileno(file)) == 0;
    const bool closed = std::fclose(file) == 0;
    if (written && closed && std::rename(beside.c_str(), path.c_str()) == 0) return {};
    const Error error = cannot_write(path);
    std::remove(beside.c_str());
    return error;
}

bool ends_with_vf(const std::string& path) {
    return path.size() >= 3 && (path.ends_with(".vf") || path.ends_with(".VF"));
}

}  // namespace

std::string view_factors_csv(const ViewFactors& table) {
    const std::size_t n = table.size();
    std::string text = "surface,area,row_sum";
    text.reserve(n * n * 12 + n * 64);
    for (std::size_t j = 1; j <= n; ++j) append(text, ",F_%zu", j);
    text += '\n';
    for (std::size_t i = 0; i < n; ++i) {
        append(text, "%zu,%.17g,%.17g", i + 1, table.areas[i], table.row_sums[i]);
        for (double F : table.row(i))
            if (F == 0)
                text += ",0";
            else
                append(text, ",%.17g", F);
        text += '\n';
    }
    return text;
}

std::string view_factors_vf(const ViewFactors& table) {
    const std::size_t n = table.size();
    std::string text = "View3D 4.0.0 0 0 0 " + std::to_string(n);  // out encl emit N
    if (text.size() < 30) text.resize(30, ' ');
    text += '\n';
    text.reserve(n * n * 9 + n * 32);
    for (double area : table.areas) append(text, " %g", area);
    text += '\n';
    for (std::size_t i = 0; i < n; ++i) {
        for (double F : table.row(i)) append(text, " %.6f", F);
        text += '\n';
    }
    for (double emittance : table.emittances) append(text, " %.3f", emittance);
    text += '\n';
    return text;
}

Result<void> write_view_factors(const std::string& path, const ViewFactors& table) {
    return write_whole(path, ends_with_vf(path) ? view_factors_vf(table) : view_factors_csv(table));
}

}  // namespace exitance
