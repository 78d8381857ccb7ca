// A bar of buttons that is one stop of the Tab key; arrow keys move within it.
export function toolbar(bar: HTMLElement): void {
    const buttons = [...bar.querySelectorAll('button')];
    const focus = (i: number) => {
        buttons.forEach((button, k) => { button.tabIndex = k === i ? 0 : -1; });
        buttons[i].focus();
    };
    bar.addEventListener('keydown', event => {
        const at = buttons.indexOf(document.activeElement as HTMLButtonElement), last = buttons.length - 1;
        const to: Record<string, number> = {ArrowRight: at === last ? 0 : at + 1, ArrowLeft: at === 0 ? last : at - 1, Home: 0, End: last};
        if (at < 0 || !(event.key in to)) return;
        event.preventDefault();
        focus(to[event.key]);
    });
}
