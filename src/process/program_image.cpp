#include "process/program_image.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/escaped.hpp"
#include "base/floating_point.hpp"
#include "pogosim/version.h"
#include "process/constructors.hpp"
#ifdef __linux__
#include "process/elf_file.hpp"
#else
#include "process/mach_o_symbols.hpp"
#endif

namespace pogosim {

namespace {

/// What the program has said that was loaded last in this thread, or is linked in.
constinit thread_local void** given_mydata = nullptr;

constexpr std::uint32_t kVersionsPerMinor = 1000;  // POGOSIM_VERSION_ENCODE: patches do not change the interface

std::string version_text(std::uint32_t encoded) {
    return fmt::format("{}.{}.{}", encoded / 1000000, encoded / 1000 % 1000, encoded % 1000);
}

/// Reads a file in one go, as programs with debug information are large. Absent: it cannot be read, see errno.
std::optional<std::vector<char>> read_file(std::filesystem::path const& file) {
    std::ifstream input(file, std::ios::binary | std::ios::ate);
    std::vector<char> content(input ? static_cast<std::size_t>(std::max<std::streamoff>(0, input.tellg())) : 0);
    input.seekg(0);
    input.read(content.data(), static_cast<std::streamsize>(content.size()));
    return input ? std::optional(std::move(content)) : std::nullopt;
}

/// A file mapped into memory, so that only the pages that are looked at are read: symbols are a small part of a
/// program.
class MappedFile {
public:
    explicit MappedFile(std::filesystem::path const& file) {
        int const descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
        struct stat status = {};
        if (descriptor >= 0 && fstat(descriptor, &status) == 0 && status.st_size > 0) {
            auto const size = static_cast<std::size_t>(status.st_size);
            void* const place = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
            if (place != MAP_FAILED) {
                bytes_ = {static_cast<char const*>(place), size};
            }
        }
        if (descriptor >= 0) {
            close(descriptor);
        }
    }
    ~MappedFile() {
        if (!bytes_.empty()) {
            munmap(const_cast<char*>(bytes_.data()), bytes_.size());
        }
    }
    MappedFile(MappedFile const&) = delete;
    MappedFile& operator=(MappedFile const&) = delete;

    std::span<char const> bytes() const { return bytes_; }

private:
    std::span<char const> bytes_{};
};

[[noreturn]] void fail(std::filesystem::path const& file, std::string const& problem) {
    throw ConfigError(fmt::format("the program '{}' {}", escaped(file.string()), problem));
}

void* loaded(std::filesystem::path const& file) {
    StandardFloatingPoint const mode;  // which constructors may change
    given_mydata = nullptr;
    return dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
}
void unload(void* library) {
    dlclose(library);
}

std::vector<char> content_of(std::filesystem::path const& file) {
    std::error_code error;
    if (std::filesystem::is_directory(file, error)) {
        fail(file, "is a folder: name the shared object in it, such as hanabi.so");
    }
    std::optional<std::vector<char>> content = read_file(file);
    if (!content) {
        fail(file, fmt::format("cannot be read: {}", std::strerror(errno)));
    }
    return *std::move(content);
}

#ifdef __linux__

#if defined(__x86_64__)
constexpr Elf64_Half kProcessor = EM_X86_64;
#elif defined(__aarch64__)
constexpr Elf64_Half kProcessor = EM_AARCH64;
#else
constexpr Elf64_Half kProcessor = EM_NONE;  // not checked
#endif

/// The reason why a file cannot be loaded; empty: there is none.
std::string problem_of(std::vector<char> const& bytes) {
    ElfFile const elf = elf_file(bytes);
    if (elf.header == nullptr) {
        return "is no shared object: make one with 'make sim', or with 'cc -shared -fPIC'";
    }
    if (kProcessor != EM_NONE && elf.header->e_machine != kProcessor) {
        return "is for another processor: make it on this machine, with 'make sim'";
    }
    bool const has_interpreter =
        std::ranges::any_of(elf.segments, [](Elf64_Phdr const& segment) { return segment.p_type == PT_INTERP; });
    if (elf.header->e_type != ET_DYN || has_interpreter) {
        return "is an executable: name the shared object that 'make sim' makes beside it, NAME.so";
    }
    return "";
}

/// Variables of inline functions and templates in C++ are unique in a process, whatever copy of the program they are in
/// (STB_GNU_UNIQUE). Here, each copy has its own.
void let_each_copy_have_its_variables(std::vector<char>& bytes) {
    ElfFile const elf = elf_file(bytes);
    for (Elf64_Shdr const& section : elf.sections) {
        if (section.sh_type != SHT_DYNSYM) {
            continue;
        }
        auto* const symbols = reinterpret_cast<Elf64_Sym*>(bytes.data() + section.sh_offset);
        for (std::size_t k = 0; k < elf_symbols(elf, section).size(); ++k) {
            unsigned char& info = symbols[k].st_info;
            if (ELF64_ST_BIND(info) == STB_GNU_UNIQUE) {
                info = ELF64_ST_INFO(STB_GLOBAL, ELF64_ST_TYPE(info));
            }
        }
    }
}

/// A copy of the file in memory, which the dynamic linker takes for a new one.
class MemoryFile {
public:
    MemoryFile(std::string const& name, std::vector<char> const& bytes)
        : descriptor_(memfd_create(name.c_str(), MFD_CLOEXEC)) {
        for (std::size_t written = 0; descriptor_ >= 0 && written < bytes.size();) {
            ssize_t const count = write(descriptor_, bytes.data() + written, bytes.size() - written);
            if (count < 0 && errno != EINTR) {
                throw std::system_error(errno, std::generic_category());
            }
            written += count > 0 ? static_cast<std::size_t>(count) : 0;
        }
        if (descriptor_ < 0) {
            throw std::system_error(errno, std::generic_category());
        }
    }
    ~MemoryFile() {
        if (descriptor_ >= 0) {
            close(descriptor_);
        }
    }
    MemoryFile(MemoryFile const&) = delete;
    MemoryFile& operator=(MemoryFile const&) = delete;

    /// Debuggers, which are other processes, find it there, too. The dynamic linker takes a name that it knows for the
    /// file that it knows, so each file has another one, by its number: "./" stands for 0 in it, and ".//" for 1.
    std::string path() const {
        static std::atomic<unsigned> files = 0;
        std::string number;
        for (unsigned rest = files++; rest > 0; rest /= 2) {
            number += rest % 2 == 1 ? ".//" : "./";
        }
        return fmt::format("/proc/{}/fd/{}{}", getpid(), number, descriptor_);
    }

private:
    int descriptor_;
};

struct Copy {
    std::shared_ptr<void> library;
    std::shared_ptr<ProgramSymbols const> symbols;
};

Copy load_copy(std::filesystem::path const& file) {
    std::vector<char> bytes = content_of(file);
    if (std::string const problem = problem_of(bytes); !problem.empty()) {
        fail(file, problem);
    }
    let_each_copy_have_its_variables(bytes);
    MemoryFile const copy(file.filename().string(), bytes);
    std::string const path = copy.path();
    void* const handle = loaded(path);
    if (handle == nullptr) {
        std::string problem = dlerror();
        if (problem.starts_with(path + ": ")) {
            problem.erase(0, path.size() + 2);
        }
        fail(file, fmt::format("cannot be loaded: {}", escaped(problem)));
    }
    return {.library = {handle, unload}, .symbols = std::make_shared<ProgramSymbols const>(symbols_of(bytes))};
}

#else

struct Copy {
    std::shared_ptr<void> library;
    std::shared_ptr<ProgramSymbols const> symbols;
};

/// The dynamic linker takes a file of another name for a new one.
Copy load_copy(std::filesystem::path const& file) {
    std::vector<char> const bytes = content_of(file);
    MachOFile const parts = mach_o_file(bytes);
    if (std::string const problem = problem_of_mach_o(parts); !problem.empty()) {
        fail(file, problem);
    }
    static std::atomic<unsigned> copies = 0;
    unsigned const number = copies++;
    if (auto const shared = mach_o_variables_of_all_copies(parts); number > 0 && !shared.empty()) {
        fail(file,
             fmt::format("has variables of inline functions or templates, such as '{}', which on this system are one "
                         "for all runs of a process: make them static, or run it in a process of its own",
                         name_by_symbol(shared.front())));
    }
    std::error_code error;
    std::filesystem::path const copy =
        std::filesystem::temp_directory_path(error) / fmt::format("pogosim-{}-{}.so", getpid(), number);
    if (error || !std::filesystem::copy_file(file, copy, error)) {
        fail(file, fmt::format("cannot be copied to the folder for temporary files: {}", error.message()));
    }
    void* const handle = loaded(copy);
    std::string const problem = handle == nullptr ? dlerror() : "";
    std::filesystem::remove(copy, error);
    if (handle == nullptr) {
        fail(file, fmt::format("cannot be loaded: {}", escaped(problem)));
    }
    return {.library = {handle, unload}, .symbols = std::make_shared<ProgramSymbols const>(mach_o_symbols(parts))};
}

#endif

}  // namespace

bool has_this_interface(pogosim_program const& program) {
    return program.interface_version / kVersionsPerMinor == POGOSIM_VERSION_COMPILED / kVersionsPerMinor;
}

void require_this_interface(pogosim_program const& program, std::filesystem::path const& file) {
    if (!has_this_interface(program)) {
        fail(file, fmt::format("was built with Pogosim {}, and this is {}: build it again",
                               version_text(program.interface_version), version_text(POGOSIM_VERSION_COMPILED)));
    }
}

ProgramImage linked_program(pogosim_program const& program, std::string name) {
    ProgramImage image;
    image.name = std::move(name);
    LoadedObject object = loaded_object_at(&program);
    image.variables = std::move(object.writable);
    image.load_address = object.load_address;
    image.main = program.main;
    image.user_data_bytes = *program.user_data_bytes;
    image.construct_user_data = *program.construct_user_data;
    image.plain_mydata = is_in_any(image.variables, given_mydata) ? given_mydata : nullptr;
    image.constructors = constructors_of(program);
    // One of its files may include pogobot.h, and the one with main() pogobase.h.
    image.is_for_sdk = program.for_sdk != nullptr && *program.for_sdk != 0 && image.user_data_bytes == 0;
    return image;
}

std::vector<char> ProgramImage::bytes_of_file() const {
    std::error_code error;
    if (loaded && (std::filesystem::last_write_time(file, error) != file_time || error)) {
        return {};
    }
    return read_file(file).value_or(std::vector<char>());
}

std::vector<ProgramFunction> ProgramImage::functions() const {
    return functions_of(bytes_of_file());
}

ProgramSymbols ProgramImage::symbols() const {
    if (loaded_symbols) {
        return *loaded_symbols;
    }
    MappedFile const mapped(file);
    return symbols_of(mapped.bytes());
}

std::vector<std::span<std::byte>> ProgramImage::memory_of_robots() const {
    std::vector<std::span<std::byte>> pieces;
    for (ProgramSymbols::Piece const& piece : symbols().memory) {
        // NOLINTNEXTLINE(performance-no-int-to-ptr): that is how the system hands out an address
        pieces.emplace_back(reinterpret_cast<std::byte*>(load_address + piece.begin), piece.end - piece.begin);
    }
    return pieces;
}

ProgramImage load_program(std::filesystem::path const& file) {
    std::error_code error;
    auto const file_time = std::filesystem::last_write_time(file, error);
    auto const [library, symbols] = load_copy(file);
    auto const* const program = static_cast<pogosim_program const*>(dlsym(library.get(), "pogosim_this_program"));
    if (program == nullptr) {
        fail(file, "is no program for Pogosim: link it as 'pkg-config --libs pogosim' says");
    }
    if (dlsym(library.get(), "pogosim_before_constructors") != reinterpret_cast<void*>(&pogosim_before_constructors)) {
        fail(file, "was built with another Pogosim than the one that is in use: build it again with this one");
    }
    require_this_interface(*program, file);
    ProgramImage image = linked_program(*program, file.string());
    forget_constructors_of(*program);
    image.loaded = library;
    image.loaded_symbols = symbols;
    image.file = std::filesystem::absolute(file, error);  // the host may change its folder
    image.file_time = file_time;
    return image;
}

}  // namespace pogosim

void pogosim_give_mydata(void** mydata) {
    pogosim::given_mydata = mydata;
}
