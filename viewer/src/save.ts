// Files that the page hands out.
export function save_file(name: string, type: string, content: string | Blob): void {
    const link = document.createElement('a');
    link.href = URL.createObjectURL(typeof content === 'string' ? new Blob([content], {type}) : content);
    link.download = name;
    link.click();
}

/** The picture as it is shown, with the legend and the labels of isolines. */
export function save_picture(canvas: HTMLCanvasElement, legend: HTMLElement, labels: HTMLElement, name: string): void {
    const out = document.createElement('canvas'), k = canvas.width / canvas.clientWidth;
    out.width = canvas.width, out.height = canvas.height;
    const context = out.getContext('2d')!;
    context.drawImage(canvas, 0, 0);
    context.scale(k, k);
    context.textBaseline = 'middle';
    for (const label of labels.children) {
        const {left, top} = (label as HTMLElement).style;
        context.font = '600 12px system-ui, sans-serif', context.textAlign = 'center', context.lineWidth = 3;
        context.strokeStyle = '#000', context.fillStyle = '#fff';
        context.strokeText(label.textContent ?? '', parseFloat(left), parseFloat(top));
        context.fillText(label.textContent ?? '', parseFloat(left), parseFloat(top));
    }
    if (!legend.hidden) draw_legend(context, legend);
    out.toBlob(blob => { if (blob) save_file(name, 'image/png', blob); });
}

function draw_legend(context: CanvasRenderingContext2D, legend: HTMLElement): void {
    const style = getComputedStyle(legend), x = legend.offsetLeft, y = legend.offsetTop;
    context.fillStyle = style.backgroundColor;
    context.fillRect(x, y, legend.offsetWidth, legend.offsetHeight);
    context.textAlign = 'left', context.font = '13px system-ui, sans-serif';
    for (const row of legend.children) {
        const at = row as HTMLElement, top = y + at.offsetTop, mark = row.querySelector('i');
        if (mark) {
            const line = mark.className === 'line', colour = getComputedStyle(mark);
            context.fillStyle = line ? colour.borderTopColor : colour.backgroundColor;
            context.fillRect(x + mark.offsetLeft, y + mark.offsetTop, 14, line ? 3 : 14);
        }
        context.fillStyle = style.color;
        context.fillText(row.textContent ?? '', x + at.offsetLeft + (mark ? 20 : 0), top + at.offsetHeight / 2);
    }
}
