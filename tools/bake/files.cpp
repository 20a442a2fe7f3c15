#include "files.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/stat.h>
#include <unistd.h>

#include "model.hpp"

namespace bake
{

namespace
{

struct Descriptor {
    int fd;
    explicit Descriptor(int fd_) : fd(fd_) {}
    Descriptor(const Descriptor &) = delete;
    Descriptor &operator=(const Descriptor &) = delete;
    ~Descriptor()
    {
        if (fd >= 0) close(fd);
    }
};

const char *kind_of(mode_t mode) { return S_ISDIR(mode) ? "is a directory" : "is not a regular file"; }

bool write_all(int fd, const std::vector<uint8_t> &bytes)
{
    size_t done = 0;
    while (done < bytes.size()) {
        ssize_t n = write(fd, bytes.data() + done, bytes.size() - done);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        done += static_cast<size_t>(n);
    }
    return true;
}

/* The permissions that open() would have given; mkstemp gives the owner's only. */
mode_t usual_mode()
{
    mode_t mask = umask(0);
    umask(mask);
    return 0666 & ~mask;
}

} // namespace

std::vector<uint8_t> read_file(const std::string &path)
{
    /* Non-blocking, so that opening a FIFO does not wait for a writer. */
    Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    struct stat status;
    if (file.fd < 0 || fstat(file.fd, &status) != 0)
        throw Error(path, "cannot be opened", std::strerror(errno));
    if (!S_ISREG(status.st_mode)) throw Error(path, "cannot be read", kind_of(status.st_mode));
    if (status.st_size == 0) throw Error(path, "cannot be read", "is empty");
    if (static_cast<uint64_t>(status.st_size) > largest_input) {
        throw Error(path, "cannot be read", "is larger than " + std::to_string(largest_input >> 20) + " MiB");
    }
    std::vector<uint8_t> bytes(static_cast<size_t>(status.st_size));
    size_t done = 0;
    while (done < bytes.size()) {
        ssize_t n = read(file.fd, bytes.data() + done, bytes.size() - done);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) throw Error(path, "cannot be read", std::strerror(errno));
        if (n == 0) throw Error(path, "cannot be read", "became shorter meanwhile");
        done += static_cast<size_t>(n);
    }
    return bytes;
}

bool resolve_beside(const std::string &beside, const std::string &relative, std::string &path,
                    std::string &why)
{
    namespace fs = std::filesystem;
    auto colon = relative.find(':'), slash = relative.find('/');
    if (relative.compare(0, 5, "data:") == 0) {
        why = "a data URI of a kind that is not supported";
        return false;
    }
    if (relative.empty() || relative[0] == '/' || relative.find('\\') != std::string::npos ||
        relative.find('\0') != std::string::npos || (colon != std::string::npos && colon < slash)) {
        why = "only relative paths are followed";
        return false;
    }
    fs::path folder = fs::path(beside).parent_path();
    if (folder.empty()) folder = ".";
    std::error_code error;
    fs::path root = fs::canonical(folder, error);
    fs::path target = error ? fs::path() : fs::weakly_canonical(root / relative, error);
    if (error) {
        why = error.message();
        return false;
    }
    fs::path inside = target.lexically_relative(root);
    if (inside.empty() || *inside.begin() == "..") {
        why = "the path leaves the folder of the glTF file";
        return false;
    }
    path = target.string();
    return true;
}

void write_file(const std::string &path, const std::vector<uint8_t> &bytes, const std::string &input)
{
    struct stat status, other;
    if (stat(path.c_str(), &status) == 0) {
        if (!S_ISREG(status.st_mode)) throw Error(path, "cannot be written", kind_of(status.st_mode));
        if (stat(input.c_str(), &other) == 0 && status.st_dev == other.st_dev &&
            status.st_ino == other.st_ino) {
            throw Error(path, "cannot be written", "is the input file");
        }
    }
    /* A link keeps pointing where it does. */
    std::error_code none;
    std::filesystem::path target = std::filesystem::canonical(path, none);
    if (none) target = path;
    std::string temporary = target.string() + ".XXXXXX";
    Descriptor file(mkstemp(&temporary[0]));
    if (file.fd < 0) throw Error(path, "cannot be written", std::strerror(errno));
    bool written = write_all(file.fd, bytes) && fchmod(file.fd, usual_mode()) == 0 && fsync(file.fd) == 0;
    if (!written || rename(temporary.c_str(), target.c_str()) != 0) {
        int reason = errno;
        unlink(temporary.c_str());
        throw Error(path, "cannot be written", std::strerror(reason));
    }
}

} // namespace bake
