#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# No page of the documentation has a sentence above 40 words, none is longer than 250 lines, and each of docs/ begins with what it answers.  Code, tables and headings are left out;
# `code` and a link count as the words that a reader sees.
# Usage: docs_words.py REPO [--table]     --table prints for each page: lines, words, longest sentence, Flesch reading ease.
# Flesch reading ease (R. Flesch, J. Appl. Psychol. 32, 1948): 206.835 - 1.015 words per sentence - 84.6 syllables per word.
import pathlib
import re
import sys

LONGEST = 40  # words of a sentence
LINES = 250  # of a page
# Habits of docs/contributing.md that a machine can see; that page itself and those of changes may name them.
HABITS = re.compile(r"\b(told|anew|whence|wherein|thereof|likewise|one's own)\b|(?<![\w.)\]])-?\.\d+\b", re.I)


def pages(repo):
    found = [repo / "README.md", *(repo / "docs").rglob("*.md"), *(repo / "data").glob("*/README.md"), *(repo / "solver").rglob("README.md"),
             *(repo / "tests").rglob("README.md")]
    return sorted(found)


def prose(text):
    """The paragraphs and list items of a page, without code, tables, headings and marks of Markdown."""
    text = re.sub(r"<!--.*?-->", "", text, flags=re.S)
    paragraphs, fenced, now = [], False, []

    def close():
        if now:
            paragraphs.append(" ".join(now))
            now.clear()
    for line in text.splitlines():
        if line.lstrip().startswith("```"):
            fenced = not fenced
            close()
            continue
        if fenced:
            continue
        bare = line.strip()
        if not bare or bare.startswith(("|", "#")) or (line.startswith("    ") and not now) or re.fullmatch(r"!\[[^\]]*\]\([^)]*\)", bare):
            close()
            continue
        if re.match(r"([-*+]|\d+\.)\s", bare):
            close()
            bare = re.sub(r"^([-*+]|\d+\.)\s+", "", bare)
        now.append(bare)
    close()
    return [plain(p) for p in paragraphs]


def plain(paragraph):
    paragraph = re.sub(r"``.*?``|`[^`]*`", "code", paragraph)
    paragraph = re.sub(r"!\[([^\]]*)\]\([^)]*\)", r"\1", paragraph)
    paragraph = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", paragraph)
    return re.sub(r"[*_]{1,2}(?=\S)|(?<=\S)[*_]{1,2}", "", paragraph)


def sentences(paragraph):
    paragraph = re.sub(r"\b(e\.g|i\.e|cf|eq|eqs|Eq|Fig|fig|ch|Ch|sec|Sec|pp|p|vol|no|No|r\.m\.s|approx|St|Dr|[A-Z])\. ", r"\1.~", paragraph)
    return [s for s in re.split(r"(?<=[.!?])[)\"']*\s+(?=[^a-z]|code|hilo)|(?<=[.!?])[)\"']*$", paragraph) if s and words(s)]


def words(sentence):
    return [w for w in re.split(r"[\s~]+", sentence) if re.search(r"\w", w)]


def syllables(word):
    word = re.sub(r"[^a-z]", "", word.lower())
    if not word:
        return 1
    count = len(re.findall(r"[aeiouy]+", word))
    if word.endswith("e") and not word.endswith("le") and count > 1:
        count -= 1
    if re.search(r"[^td]ed$", word) and count > 1:
        count -= 1
    return max(count, 1)


def measure(path):
    all_sentences = [s for p in prose(path.read_text()) for s in sentences(p)]
    counts = [len(words(s)) for s in all_sentences]
    total = sum(counts)
    ease = 0.0
    if total:
        ease = 206.835 - 1.015 * total / len(counts) - 84.6 * sum(syllables(w) for s in all_sentences for w in words(s)) / total
    return all_sentences, counts, total, ease


def main():
    repo = pathlib.Path(sys.argv[1]).resolve()
    faults = []
    for path in pages(repo):
        name = path.relative_to(repo)
        all_sentences, counts, total, ease = measure(path)
        lines = len(path.read_text().splitlines())
        if "--table" in sys.argv:
            print(f"{str(name):44} {lines:5} lines {total:6} words, longest sentence {max(counts, default=0):3}, above {LONGEST}: "
                  f"{sum(c > LONGEST for c in counts):3} of {len(counts):4}, Flesch {ease:5.1f}")
        faults += [f"{name}: a sentence of {c} words: {s}" for s, c in zip(all_sentences, counts) if c > LONGEST]
        if not re.match("contributing|changes|references|errors", path.name):
            faults += [f"{name}: \"{m[0]}\" (docs/contributing.md, Words): {s}" for s in all_sentences for m in HABITS.finditer(s)]
        if "docs" in name.parts[0:1] and "tools" not in name.parts and name.stem not in ("index", "api") and "*Answers:" not in path.read_text()[:400]:
            faults.append(f"{name}: does not begin with what it answers (*Answers: ...*)")
        if lines > LINES:
            faults.append(f"{name}: {lines} lines, more than {LINES}")
    for fault in faults:
        print(f"docs_words: {fault}", file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
