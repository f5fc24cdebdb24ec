%(complete_func)s() {
    local IFS=$'\n' line
    COMPREPLY=()
    while read -r line; do
        case "${line%%%%,*}" in
            dir) compopt -o filenames; COMPREPLY+=($(compgen -d -- "${line#*,}")) ;;
            file) compopt -o filenames; COMPREPLY+=($(compgen -f -- "${line#*,}")) ;;
            *) COMPREPLY+=("${line#*,}") ;;
        esac
    done < <(COMP_WORDS="${COMP_WORDS[*]}" COMP_CWORD=$COMP_CWORD %(complete_var)s=bash_complete "$1")
}
complete -o nosort -F %(complete_func)s %(prog_name)s
