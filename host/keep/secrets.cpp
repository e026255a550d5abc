#include "host/keep/secrets.h"

#include <cstring>

#include "host/keep/file.h"
#include "net/wire/fields.h"

namespace slosh::keep {
namespace {

constexpr char kSecretsMagic[8] = {'S', 'L', 'O', 'S', 'H', 'K', 'E', 'Y'};
constexpr std::uint32_t kSecretsVersion = 1;

// In this order, each once.
enum SecretsPart : std::uint8_t { kSecretsHead = 1, kServerState, kSecretsEnd };

struct SecretsHead {
  std::uint32_t version = kSecretsVersion;
  std::uint64_t run = 0;
};
template <class V>
void visit(V& v, SecretsHead& m) {
  v.natural("version", m.version, kSecretsVersion, kSecretsVersion);
  v.bits64("run", m.run);
}

Result<Secrets> read_one(const std::filesystem::path& path) {
  const Result<File> opened = open_to_read(path);
  if (!opened) return opened.error();
  return read_secrets_file(opened.value().get(), path.string());
}

}  // namespace

Result<Secrets> read_secrets_file(std::FILE* file, const std::string& name) {
  const auto damaged = [&](const std::string& what) {
    return Error{name, "these secrets of a host are damaged: " + what, ""};
  };
  char magic[sizeof kSecretsMagic];
  if (std::fread(magic, 1, sizeof magic, file) != sizeof magic ||
      std::memcmp(magic, kSecretsMagic, sizeof magic) != 0)
    return damaged("they do not begin as such");
  Secrets secrets;
  ChunkReader reader(file);
  Chunk chunk;
  for (std::uint8_t part = kSecretsHead; part <= kSecretsEnd; ++part) {
    const ChunkOutcome outcome = reader.next(chunk);
    if (outcome == ChunkOutcome::kDamaged) return damaged(reader.problem());
    if (outcome != ChunkOutcome::kChunk) return damaged("they are cut off");
    if (chunk.type != part) return damaged("their parts are in disorder");
    if (part == kSecretsHead) {
      SecretsHead head;
      if (const wire::Fault fault = wire::decode(chunk.content, head)) return damaged(fault.text());
      secrets.run = head.run;
    } else if (part == kServerState) {
      secrets.server_state = std::move(chunk.content);
    }
  }
  return secrets;
}

std::filesystem::path secrets_of(const std::filesystem::path& checkpoint) {
  const std::string previous = previous_of({}).string();
  std::string name = checkpoint.string();
  if (name.ends_with(previous)) name.resize(name.size() - previous.size());
  return name + ".secrets";
}

Result<bool> write_secrets(const std::filesystem::path& checkpoint, std::uint64_t run,
                           ByteView server_state) {
  Bytes out(std::begin(kSecretsMagic), std::end(kSecretsMagic));
  append_chunk(kSecretsHead, wire::encoded(SecretsHead{kSecretsVersion, run}), out);
  append_chunk(kServerState, server_state, out);
  append_chunk(kSecretsEnd, {}, out);
  const std::filesystem::path file = secrets_of(checkpoint);
  // What is damaged must not push out the one before it, which is whole.
  return replace_file(file, out, read_one(file) ? Replaced::kKept : Replaced::kDropped);
}

Result<std::optional<Secrets>> read_secrets(const std::filesystem::path& checkpoint) {
  const std::filesystem::path file = secrets_of(checkpoint);
  const std::filesystem::path before = previous_of(file);
  std::error_code code;
  if (!std::filesystem::exists(file, code) && !std::filesystem::exists(before, code))
    return std::optional<Secrets>{};
  Result<Secrets> newest = read_one(file);
  if (newest) return std::optional<Secrets>(std::move(newest.value()));
  Result<Secrets> previous = read_one(before);
  if (!previous) {
    return Error{file.string(), newest.error().what + ", and there is no whole one before it",
                 "Move both away to carry on with a new key and new links"};
  }
  previous.value().note =
      newest.error().text() +
      ". The ones before them are used: links that were made or revoked, and people who came, "
      "right before the end are not known";
  return std::optional<Secrets>(std::move(previous.value()));
}

}  // namespace slosh::keep
