#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <new>

// Replaces operator new, so that large arrays begin at a page boundary. Equal arrays of all processes on a node then
// have the same layout in pages, at any address, and the processes can share these pages (`share_on_node`).

namespace {

void* allocate(std::size_t size, std::size_t alignment) {
    static const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    constexpr std::size_t min_shared_bytes = std::size_t(1) << 20;  // bytes; smaller arrays are not shared
    if (size >= min_shared_bytes) alignment = std::max(alignment, page);
    for (;;) {
        void* const found = alignment > alignof(std::max_align_t)
                                ? std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)
                                : std::malloc(std::max<std::size_t>(size, 1));
        if (found) return found;
        const std::new_handler make_room = std::get_new_handler();
        if (!make_room) throw std::bad_alloc();
        make_room();
    }
}

}  // namespace

void* operator new(std::size_t size) {
    return allocate(size, 1);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    return allocate(size, static_cast<std::size_t>(alignment));
}

void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    std::free(memory);
}
