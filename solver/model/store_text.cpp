// SPDX-License-Identifier: GPL-3.0-or-later
// What goes with files besides their arrays: digests, text written as a whole, relative paths, names, command lines.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "base/digest.hpp"
#include "base/error.hpp"
#include "model/inputs.hpp"
#include "model/store_impl.hpp"

namespace hilo {
namespace fs = std::filesystem;
namespace {

/// A file that closes itself; exit 4 when it may not be read, 2 when it is not there.
struct Reader {
  explicit Reader(const std::string& path, const std::string& where) {
    const std::string prefix = where.empty() ? "" : path + ": ", at = where.empty() ? path : where;
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);  // a pipe that nobody writes to would wait for ever
    file = descriptor < 0 ? nullptr : ::fdopen(descriptor, "rb");
    if (!file) {
      const int error = errno;
      if (error == ENOENT) throw Error(at, prefix + "no such file");
      throw Error(at, fmt::format("{}cannot read: {}", prefix, std::strerror(error)), "", error == ELOOP ? Exit::input : Exit::resources);
    }
    struct stat status;
    const bool known = ::fstat(fileno(file), &status) == 0, folder = known && S_ISDIR(status.st_mode);
    if (folder || (known && (S_ISCHR(status.st_mode) || S_ISBLK(status.st_mode)))) {  // a pipe is welcome: <(command)
      std::fclose(file);
      throw Error(at, fmt::format("{}is a {}, not a file", prefix, folder ? "folder" : "device"));
    }
    if (known && S_ISFIFO(status.st_mode) && !somebody_writes()) {
      std::fclose(file);
      throw Error(at, prefix + "is a pipe, and nobody writes to it");
    }
    ::fcntl(descriptor, F_SETFL, O_RDONLY);  // from now on reads wait
    note_input(path);
  }
  ~Reader() { std::fclose(file); }
  Reader(const Reader&) = delete;
  std::FILE* file;

 private:
  /// Whether a pipe has a writer, or something in it, within two seconds: without a writer it is at its end.
  bool somebody_writes() const {
    for (int k = 0; k < 40; ++k) {
      char c = 0;
      const auto n = ::read(fileno(file), &c, 1);
      if (n == 1) std::ungetc(c, file);
      if (n != 0) return true;
      ::usleep(50000);
    }
    return false;
  }
};

fs::path folder_of(const std::string& file) {
  const fs::path parent = fs::path(file).parent_path();
  return fs::weakly_canonical(parent.empty() ? "." : parent);
}

}  // namespace

std::string to_link_name(const std::string& name) {
  if (name == ".") return "%2E";
  std::string out;
  for (const char c : name) out += c == '/' ? "%2F" : c == '%' ? "%25" : std::string(1, c);
  return out;
}

std::string from_link_name(const std::string& link) {
  std::string out;
  for (size_t i = 0; i < link.size(); ++i) {
    const auto code = link.substr(i, 3);
    if (code == "%2F" || code == "%25" || code == "%2E")
      out += code == "%2F" ? '/' : code == "%25" ? '%' : '.', i += 2;
    else
      out += link[i];
  }
  return out;
}

std::string relative_to(const std::string& from, const std::string& file) {
  return (folder_of(file) / fs::path(file).filename()).lexically_relative(folder_of(from)).string();
}

std::string followed(const std::string& path) {
  fs::path p = path;
  std::error_code failed;
  for (int k = 0; k < 40 && fs::is_symlink(fs::symlink_status(p, failed)); ++k) p = p.parent_path() / fs::read_symlink(p, failed);
  return p.string();
}

std::string resolved_from(const std::string& from, const std::string& relative) {
  return (fs::path(followed(from)).parent_path() / relative).lexically_normal().string();
}

std::string digest(const std::string& path) {
  const Reader reader(path, "");
  Digest whole;
  std::vector<std::byte> block(1 << 18);
  while (const size_t n = std::fread(block.data(), 1, block.size(), reader.file)) whole.add(std::span(block.data(), n));
  return whole.text();
}

void refuse_special(const std::string& path) {
  std::error_code ignored;
  const auto type = fs::status(path, ignored).type();
  if (type == fs::file_type::directory) throw Error(path, "cannot write: is a folder", "", Exit::resources);
  if (type != fs::file_type::regular && type != fs::file_type::not_found && type != fs::file_type::none)
    throw Error(path, "cannot write: a device or pipe is in its place", "name a regular file", Exit::resources);
  const std::string target = followed(path);
  if (fs::is_symlink(fs::symlink_status(target, ignored)) || fs::exists(path, ignored) != fs::exists(target, ignored))
    throw Error(path, "cannot write: a link in its place leads to no file with a name", "name a regular file", Exit::resources);
}

void write_text_file(const std::string& path, const std::string& text) {
  const std::string target = followed(path), temporary = fmt::format("{}.tmp-{}", target, ::getpid());
  const auto fail = [&](int error) {
    ::unlink(temporary.c_str());
    throw Error(path, fmt::format("cannot write: {}", std::strerror(error)), "", Exit::resources);
  };
  check_output(path);
  const int d = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (d < 0) fail(errno);
  for (size_t done = 0; done < text.size();) {
    const auto n = ::write(d, text.data() + done, text.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) {
      const int error = n < 0 ? errno : ENOSPC;
      ::close(d);
      fail(error);
    }
    done += static_cast<size_t>(n);
  }
  if (::close(d) != 0) fail(errno);
  if (::rename(temporary.c_str(), target.c_str()) != 0) fail(errno);
}

std::string read_text_file(const std::string& path, const std::string& where) {
  const Reader reader(path, where);
  std::string text;
  std::vector<char> block(1 << 16);
  while (const size_t n = std::fread(block.data(), 1, block.size(), reader.file)) {
    text.append(block.data(), n);
    if (text.size() > most_text)
      throw Error(where.empty() ? path : where,
                  fmt::format("{}more than {} MB of text", where.empty() ? "" : path + ": ", most_text >> 20));
  }
  if (std::ferror(reader.file)) throw Error(where.empty() ? path : where, "cannot read", "", Exit::resources);
  return text;
}

std::string command_line(int argc, char** argv) {
  std::string line;
  for (int i = 0; i < argc; ++i) {
    std::string word = i == 0 ? fs::path(argv[i]).filename().string() : argv[i];
    const bool plain =
        !word.empty() &&
        word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./:,@%^") == std::string::npos;
    if (!plain) {
      std::string quoted = "'";
      for (const char c : word) quoted += c == '\'' ? "'\\''" : std::string(1, c);
      word = quoted + "'";
    }
    line += (i ? " " : "") + word;
  }
  return line;
}

}  // namespace hilo
