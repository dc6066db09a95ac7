#!/usr/bin/env python3
"""make_manual.py PROGRAM MANUAL COMPLETION: the man page and bash's completion of the program out of its --help, which is made from the
tables of options, settings and strokes."""

import re
import subprocess
import sys


def help_of(program, *commands):
    return subprocess.run([program, *commands, "--help"], check=True, capture_output=True, text=True).stdout


def roff(text):
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\n".join("\\&" + line if line.startswith((".", "'")) else line for line in text.splitlines())


def options_of(text):
    """[(option, rest, meaning)], whether the meaning stands on the same line or the next ones."""
    found = []
    for line in text.splitlines():
        match = re.match(r"  (-\S+(?: \S.*?)?)(?:\s{2,}(\S.*))?$", line)
        if match and match[1].startswith("-"):
            found.append([match[1], match[2] or ""])
        elif found and re.match(r"\s{20,}\S", line):
            found[-1][1] = (found[-1][1] + " " + line.strip()).strip()
        elif not line.startswith(" "):
            found.append(["", ""])  # another section: its lines belong to no option
    return [(option, meaning) for option, meaning in found if option]


def names(options):
    return [name for option, _ in options for name in re.findall(r"(?:^|,)(--?[\w-]+)", option.split(" ")[0].split(":")[0])]


def main():
    program, manual, completion = sys.argv[1:4]
    whole = help_of(program)
    version = subprocess.run([program, "--version"], check=True, capture_output=True, text=True).stdout.split()[-1]
    # The commands are those lines of the whole text that stand alone at its margin.
    commands = [line for line in whole[whole.index("Subcommands:"):].splitlines()[1:] if re.fullmatch(r"[a-z]+", line)]
    commands = [c for c in commands if c not in ("compare", "merge")]
    texts = {c: help_of(program, c) for c in commands}
    own = whole[:whole.index("Subcommands:")]
    settings = re.search(r"(Settings for --set.*?)\n\n", whole, re.S)[1].splitlines()[1:]
    strokes = re.search(r"(Strokes of the simulated hand.*?)\n\n", whole, re.S)[1].splitlines()[1:]

    page = [f'.TH TOUCHSTONE 1 "" "Touchstone {version}" "User Commands"', ".SH NAME", "touchstone \\- see and touch 3D models",
            ".SH SYNOPSIS", ".B touchstone", "[OPTIONS] [SCENE]", ".br", ".B touchstone", "COMMAND [OPTIONS]", ".SH DESCRIPTION",
            roff(whole.splitlines()[0])]

    def section(title, text, summary=""):
        page.extend([f".SH {title}"] + ([roff(summary)] if summary else []))
        for option, meaning in options_of(text):
            page.extend([".TP", ".B " + roff(option), roff(meaning)])

    section("OPTIONS", own)
    for command in commands:
        section("TOUCHSTONE " + command.upper(), texts[command], texts[command].splitlines()[0])
    for title, lines in (("SETTINGS", settings), ("STROKES", strokes)):
        page.append(f".SH {title}")
        for line in lines:
            name, _, meaning = line.strip().partition("  ")
            page.extend([".TP", ".B " + roff(name), roff(meaning.strip())])
    page.extend([".SH EXIT STATUS", "0 done, 1 bad input or a missing facility, 2 wrong usage."])
    with open(manual, "w") as out:
        out.write("\n".join(page) + "\n")

    setting_words = [re.match(r"\s*(\w+)=", line)[1] + "=" for line in settings]
    stroke_words = [line.split()[0] for line in strokes]
    cases = "\n".join(f"        {c}) words='{' '.join(names(options_of(texts[c])))}' ;;" for c in commands)
    with open(completion, "w") as out:
        out.write(f"""# bash completion of touchstone {version}; made from its --help
_touchstone() {{
    local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}} words=
    case $previous in
    --set) compopt -o nospace; mapfile -t COMPREPLY < <(compgen -W '{' '.join(setting_words)}' -- "$current"); return ;;
    --stroke) mapfile -t COMPREPLY < <(compgen -W '{' '.join(stroke_words)}' -- "$current"); return ;;
    esac
    if [[ $current == -* ]]; then
        case ${{COMP_WORDS[1]}} in
{cases}
        *) words='{' '.join(names(options_of(own)))}' ;;
        esac
        mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
        return
    fi
    mapfile -t COMPREPLY < <(compgen -f -- "$current"; [ "$COMP_CWORD" -gt 1 ] || compgen -W '{' '.join(commands)}' -- "$current")
    compopt -o filenames
}}
complete -F _touchstone touchstone
""")


main()
