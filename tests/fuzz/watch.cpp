#include "fuzz/watch.hpp"

#include <errno.h>
#include <malloc.h>
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>

// Other names of the C library's allocator functions, whose usual names are defined below.
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);
}

namespace {

std::atomic<std::size_t> limit{0};
std::atomic<long long> held{0}, most{0};

void say(const char* text) {
    if (::write(STDERR_FILENO, text, std::strlen(text)) < 0) return;
}

void check(std::size_t bytes) {
    const std::size_t allowed = limit.load(std::memory_order_relaxed);
    if (allowed == 0 || bytes <= allowed) return;
    limit = 0;
    say("memory: more is asked for than ten times the file's size and 64 MiB\n");
    std::abort();
}

void* took(void* p) {
    if (!p) return p;
    const long long now = held += static_cast<long long>(::malloc_usable_size(p));
    if (now > most.load(std::memory_order_relaxed)) most = now;
    return p;
}

void gave(void* p) {
    if (p) held -= static_cast<long long>(::malloc_usable_size(p));
}

}  // namespace

extern "C" {

void* malloc(std::size_t n) {
    check(n);
    return took(__libc_malloc(n));
}
void* calloc(std::size_t n, std::size_t m) {
    std::size_t bytes = 0;
    check(__builtin_mul_overflow(n, m, &bytes) ? static_cast<std::size_t>(-1) : bytes);
    return took(__libc_calloc(n, m));
}
void* realloc(void* p, std::size_t n) {
    check(n);
    gave(p);
    void* const q = __libc_realloc(p, n);
    if (!q && n > 0) {
        took(p);
        return nullptr;
    }
    return took(q);
}
void* memalign(std::size_t alignment, std::size_t n) {
    check(n);
    return took(__libc_memalign(alignment, n));
}
void* aligned_alloc(std::size_t alignment, std::size_t n) {
    return memalign(alignment, n);
}
int posix_memalign(void** out, std::size_t alignment, std::size_t n) {
    *out = memalign(alignment, n);
    return *out ? 0 : ENOMEM;
}
void free(void* p) {
    gave(p);
    __libc_free(p);
}

}  // extern "C"

namespace exitance::fuzz {

void limit_memory(std::size_t bytes) {
    // Copies of the process have no limit here, as for users: the reader itself limits them.
    [[maybe_unused]] static const int watched = ::pthread_atfork(nullptr, nullptr, [] { limit = 0; });
    held = 0, most = 0;
    limit = bytes;
}

std::size_t most_held_by_copies() {
    rusage self{}, copies{};
    ::getrusage(RUSAGE_SELF, &self);
    ::getrusage(RUSAGE_CHILDREN, &copies);
    return static_cast<std::size_t>(std::max(0L, copies.ru_maxrss - self.ru_maxrss)) * 1024;  // Linux counts in KiB
}

std::size_t most_held() {
    return static_cast<std::size_t>(std::max(0LL, most.load()));
}

}  // namespace exitance::fuzz
