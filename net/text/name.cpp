#include "net/text/name.h"

#include <unicode/uchar.h>
#include <unicode/unorm2.h>
#include <unicode/uspoof.h>
#include <unicode/ustring.h>
#include <unicode/utf16.h>

#include <algorithm>
#include <vector>

#include "net/text/clean.h"

namespace slosh {
namespace {

// Far above a name: what is longer is cut before any work is done on it.
constexpr std::size_t kMaxForeign = 256;

std::u16string to_utf16(std::string_view text) {
  std::u16string out(text.size(), u'\0');  // never more units than bytes
  std::int32_t length = 0;
  UErrorCode status = U_ZERO_ERROR;
  u_strFromUTF8WithSub(out.data(), static_cast<std::int32_t>(out.size()), &length, text.data(),
                       static_cast<std::int32_t>(text.size()), 0xFFFD, nullptr, &status);
  out.resize(U_SUCCESS(status) ? static_cast<std::size_t>(length) : 0);
  return out;
}

std::string to_utf8(const std::u16string& text) {
  std::string out(3 * text.size(), '\0');
  std::int32_t length = 0;
  UErrorCode status = U_ZERO_ERROR;
  u_strToUTF8WithSub(out.data(), static_cast<std::int32_t>(out.size()), &length, text.data(),
                     static_cast<std::int32_t>(text.size()), 0xFFFD, nullptr, &status);
  out.resize(U_SUCCESS(status) ? static_cast<std::size_t>(length) : 0);
  return out;
}

/// Calls a function of ICU's that fills a buffer, again with a larger one where the first was too small. On
/// an error the text as it was: less is known of it then, and nothing is lost.
template <class Fill>
std::u16string filled(const std::u16string& text, Fill&& fill) {
  std::u16string out(4 * text.size() + 64, u'\0');
  for (int attempt = 0; attempt < 2; ++attempt) {
    UErrorCode status = U_ZERO_ERROR;
    const std::int32_t length = fill(out.data(), static_cast<std::int32_t>(out.size()), &status);
    if (status == U_BUFFER_OVERFLOW_ERROR) {
      out.resize(static_cast<std::size_t>(length) + 1);
      continue;
    }
    if (U_FAILURE(status)) return text;
    out.resize(static_cast<std::size_t>(length));
    return out;
  }
  return text;
}

using GetNormalizer = const UNormalizer2* (*)(UErrorCode*);

std::u16string normalized(const std::u16string& text, GetNormalizer get) {
  UErrorCode status = U_ZERO_ERROR;
  const UNormalizer2* normalizer = get(&status);
  if (U_FAILURE(status)) return text;
  return filled(text, [&](char16_t* out, std::int32_t size, UErrorCode* problem) {
    return unorm2_normalize(normalizer, text.data(), static_cast<std::int32_t>(text.size()), out, size,
                            problem);
  });
}

std::u16string confusables_folded(const std::u16string& text) {
  static USpoofChecker* const checker = [] {
    UErrorCode status = U_ZERO_ERROR;
    USpoofChecker* made = uspoof_open(&status);
    return U_SUCCESS(status) ? made : nullptr;
  }();
  if (!checker) return text;
  return filled(text, [&](char16_t* out, std::int32_t size, UErrorCode* problem) {
    return uspoof_getSkeleton(checker, 0, text.data(), static_cast<std::int32_t>(text.size()), out, size,
                              problem);
  });
}

template <class Visit>
void each_code_point(const std::u16string& text, Visit&& visit) {
  const auto size = static_cast<std::int32_t>(text.size());
  for (std::int32_t at = 0; at < size;) {
    const std::int32_t from = at;
    UChar32 code = 0;
    U16_NEXT(text.data(), at, size, code);
    const std::u16string_view units(text.data() + from, static_cast<std::size_t>(at - from));
    visit(code, units);
  }
}

bool is_accent(UChar32 code) {
  const auto block = ublock_getCode(code);
  return block == UBLOCK_COMBINING_DIACRITICAL_MARKS ||
         block == UBLOCK_COMBINING_DIACRITICAL_MARKS_EXTENDED ||
         block == UBLOCK_COMBINING_DIACRITICAL_MARKS_SUPPLEMENT ||
         block == UBLOCK_COMBINING_MARKS_FOR_SYMBOLS;
}

bool is_mark(UChar32 code) {
  return (U_GET_GC_MASK(code) & U_GC_M_MASK) != 0;
}

/// Emoji and the like; frames, blanks and blocks, of which images of a screen can be made, are not.
bool is_pictograph(UChar32 code) {
  if ((U_GET_GC_MASK(code) & (U_GC_SO_MASK | U_GC_SK_MASK)) == 0) return false;
  return code >= 0x1F000 || (code >= 0x2600 && code < 0x2800);
}

/// What stands in a name for a character: the character, one like it, or a space.
UChar32 in_name(UChar32 code) {
  const std::uint32_t category = U_GET_GC_MASK(code);
  if ((category & (U_GC_L_MASK | U_GC_M_MASK | U_GC_N_MASK)) != 0 || is_pictograph(code)) return code;
  if ((category & U_GC_PD_MASK) != 0) return '-';
  if (code == '\'' || code == 0x2019 || code == 0x2018) return '\'';
  if (code == '.' || code == '_') return code;
  return ' ';
}

void append(std::u16string& out, UChar32 code) {
  if (code > 0xFFFF) {
    out += static_cast<char16_t>(U16_LEAD(code));
    out += static_cast<char16_t>(U16_TRAIL(code));
  } else {
    out += static_cast<char16_t>(code);
  }
}

/// Words of the allowed characters.
std::vector<std::string> words_of(const std::u16string& text) {
  std::vector<std::string> words;
  std::u16string word;
  const auto end_word = [&] {
    if (!word.empty()) words.push_back(to_utf8(word));
    word.clear();
  };
  each_code_point(text, [&](UChar32 given, std::u16string_view) {
    const UChar32 code = in_name(given);
    if (code == ' ') return end_word();
    if (is_mark(code) && word.empty()) return;  // nothing to stand on
    append(word, code);
  });
  end_word();
  return words;
}

/// What hosts' notices say of people: "X is here", "X has left", "X lets the world go on".
bool is_notice_word(const std::string& word) {
  static const std::vector<std::string> skeletons = [] {
    std::vector<std::string> out;
    for (const char* of_notices :
         {"is",    "are",    "was",    "were",  "has",  "have",   "had",      "did",      "does",   "not",
          "left",  "leaves", "joined", "joins", "lets", "paused", "pauses",   "set",      "sets",   "took",
          "takes", "holds",  "held",   "lost",  "lose", "loses",  "released", "releases", "kicked", "banned"})
      out.push_back(name_skeleton(of_notices));
    return out;
  }();
  return std::find(skeletons.begin(), skeletons.end(), name_skeleton(word)) != skeletons.end();
}

bool is_letter_or_digit(const std::string& word) {
  bool any = false;
  each_code_point(to_utf16(word), [&](UChar32 code, std::u16string_view) {
    any = any || (U_GET_GC_MASK(code) & (U_GC_L_MASK | U_GC_N_MASK)) != 0 || is_pictograph(code);
  });
  return any;
}

}  // namespace

std::string clean_name(std::string_view foreign) {
  const std::u16string composed =
      normalized(to_utf16(clean_text(foreign, kMaxForeign)), unorm2_getNFKCInstance);
  std::string name;
  for (const std::string& word : words_of(to_utf16(clean_text(to_utf8(composed), kMaxForeign)))) {
    if (name.empty() && (is_notice_word(word) || !is_letter_or_digit(word))) continue;  // begins no name
    if (is_notice_word(word)) break;
    const std::size_t space = name.empty() ? 0 : 1;
    const std::string cut = clean_text(word, kMaxNameBytes - std::min(kMaxNameBytes, name.size() + space));
    if (cut.empty()) break;
    // What is left of a cut word may be a word of notices where the whole was none.
    if (cut != word && is_notice_word(cut)) break;
    name.append(space, ' ').append(cut);
    if (cut != word) break;
  }
  return name;
}

std::string name_skeleton(std::string_view name) {
  std::u16string look = normalized(to_utf16(clean_text(name, 4 * kMaxForeign)), unorm2_getNFKCInstance);
  // Folding case makes new look-alikes and the other way round: until nothing changes.
  for (int round = 0; round < 4; ++round) {
    const std::u16string next = normalized(confusables_folded(look), unorm2_getNFKCCasefoldInstance);
    if (next == look) break;
    look = next;
  }
  const std::u16string apart = normalized(look, unorm2_getNFDInstance);
  std::u16string out;
  each_code_point(apart, [&](UChar32 code, std::u16string_view units) {
    const std::uint32_t category = U_GET_GC_MASK(code);
    if (is_accent(code) || (category & (U_GC_Z_MASK | U_GC_P_MASK)) != 0) return;
    if (code == 'i' || code == '1' || code == '|') {
      out += u'l';
    } else if (code == '0') {
      out += u'o';
    } else {
      out += units;
    }
  });
  return to_utf8(out.empty() ? apart : out);
}

}  // namespace slosh
