#pragma once

// Files that appear under their name only when they are whole and on the disk.

#include <cstdint>
#include <filesystem>
#include <string>

namespace gcpdda {

/// Where a file grows until it is complete.
std::filesystem::path unfinished_name(const std::filesystem::path &path);

/// Takes bytes [begin, end) of the unfinished file from the disk, so that writing them cannot fail for want
/// of space, where the file system can promise this. The file ends at `end` afterwards, and reads as zeros
/// where nothing has been written. Throws FileError when the space is not there.
void reserve(const std::filesystem::path &path, std::int64_t begin, std::int64_t end);

/// What has been written to the unfinished file so far begins to go to the disk, so that publish() need not
/// wait for all of it. Only a hint: nothing fails.
void start_to_sync(const std::filesystem::path &path);

/// Syncs the unfinished file to the disk and gives it its final name. Throws FileError.
void publish(const std::filesystem::path &path);

/// The whole file at once, under its final name only when complete. Throws FileError.
void write_file(const std::filesystem::path &path, const std::string &text);

/// The same for a file that can be made again from what is on the disk: it is not synced.
void write_index(const std::filesystem::path &path, const std::string &text);

/// What has been written to a file, or the names in a folder, are on the disk afterwards. Throws FileError.
void sync_file(const std::filesystem::path &path);
void sync_directory(const std::filesystem::path &path);

/// Throws FileError.
void make_directory(const std::filesystem::path &path);

} // namespace gcpdda
