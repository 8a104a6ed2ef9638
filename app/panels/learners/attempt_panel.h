#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>

#include "app/panels/widgets/text_field.h"
#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/trainer/learners_page.h"

namespace insonate::ui {

/// What a click asks for.
enum class AttemptRequest { none, review, report };

/// Draws the chosen attempt: what can be done with it, the comments on it, and the field for another one. The typed
/// text belongs to its attempt, and is there again when the attempt is chosen again.
class AttemptPanel {
public:
  using Run = std::function<void(const std::function<void()>&)>;

  /// @param run     runs what may throw; an exception becomes a problem to acknowledge
  /// @param places  receives the positions of what can be clicked, by name
  AttemptRequest draw(const Theme& theme, Rect where, LearnersPage& page, const Run& run,
                      std::map<std::string, Rect>& places);

  bool types_text() const { return comment_.is_open() || author_.is_open(); }
  bool ready() const { return comment_.ready() || author_.ready(); }
  /// Closes the open field. With `keep` it stores the comment, or takes the author; without it forgets what was typed.
  void close_fields(bool keep);

private:
  void draw_comments(const Theme& theme, const Rect& where, LearnersPage& page, const Run& run,
                     std::map<std::string, Rect>& places);
  void choose_author(LearnersPage& page);
  void draw_fields(const Theme& theme, Rect where, LearnersPage& page, const Run& run,
                   std::map<std::string, Rect>& places);

  TextField comment_{4 * Comment::kMaxCharacters}, author_;
  /// An attempt in its database: numbers of other databases are the same.
  using Key = std::pair<std::string, std::int64_t>;
  std::map<Key, std::string> drafts_;
  std::string typed_author_;
  Key shown_;                  ///< the attempt of the last frame; number 0: none
  std::int64_t doubtful_ = 0;  ///< comment that the next click on its button removes; 0 for none
  bool store_ = false, forget_ = false, author_was_open_ = false, author_is_refused_ = false;
};

}  // namespace insonate::ui
