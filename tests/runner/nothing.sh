#!/bin/sh
while read -r word set path; do
    case $word in
    sahara) echo "runner 1 closest" ;;
    scene)
        [ "$1" = unbuilt ] && exit 7
        [ "$1" = refuses ] && echo "error it holds no more than two triangles" && continue
        [ "$1" = leaves ] && sleep 600 &
        echo "built 0.001 0" ;;
    rays)
        [ "$1" = objects ] && echo "error no ray fits." && continue
        [ "$1" = miscounts ] && echo "loaded 7" && continue
        tail -c +9 "$path" | head -c 24 > "${path%.rays}.head"
        od -A n -t u8 -j 16 -N 8 "$path" | tr -d ' ' > "${path%.rays}.count"
        echo "loaded $(od -A n -t u8 -j 16 -N 8 "$path" | tr -d ' ')" ;;
    pass)
        [ "$1" = dies ] && exit 3
        [ "$1" = hangs ] && exec sleep 600
        [ "$1" = liar ] && sleep 0.05
        [ "$1" = slow ] && sleep 0.1
        case $1 in nan) echo "passed nan" ;; backwards) echo "passed -1" ;; *) echo "passed 0.001" ;; esac
        [ "$1" = floods ] && exec yes "that was much"
        [ "$1" = chatters ] && echo "that was quick" ;;
    hits)
        count=$(cat "${path%.hits}.count")
        [ "$1" = few ] && cut=8
        { printf SAHAHITS; cat "${path%.hits}.head"; head -c $((8 * count - cut)) /dev/zero | tr '\0' '\377'; } > "$path"
        echo "written $count" ;;
    esac
done
