// The range of the colours: two handles on one track, two numbers, linear or logarithmic, palette and threshold.
import {above_zero, round_steps, short, steps_within} from './colours';
import {by_id} from './page';

const track = 1000;  // positions of a handle

export class ScaleControl {
    /** The values that there are; the track goes a little beyond. */
    private limits: [number, number] = [0, 1];
    private chosen: [number, number] | null = null;
    private lo = by_id<HTMLInputElement>('scale_lo');
    private hi = by_id<HTMLInputElement>('scale_hi');
    private lo_number = by_id<HTMLInputElement>('scale_lo_number');
    private hi_number = by_id<HTMLInputElement>('scale_hi_number');
    private log = by_id<HTMLInputElement>('scale_log');
    private threshold_number = by_id<HTMLInputElement>('threshold');

    /** `renewed`: the values are to be found again, and then shown. */
    constructor(private changed: () => void, renewed: () => void) {
        for (const handle of [this.lo, this.hi]) handle.addEventListener('input', () => this.drag(handle));
        for (const number of [this.lo_number, this.hi_number]) number.addEventListener('change', () => this.type());
        this.log.addEventListener('change', changed);
        for (const id of ['palette', 'threshold']) by_id(id).addEventListener('input', changed);
        by_id('scale_auto').addEventListener('click', () => { this.chosen = null, this.log.checked = false; renewed(); });
    }

    /** The range that somebody chose; null: automatic. */
    get choice(): [number, number] | null { return this.chosen; }
    set choice(range: [number, number] | null) { this.chosen = range; }

    get palette(): string { return by_id<HTMLSelectElement>('palette').value; }
    /** Negative: none. */
    get threshold(): number { return this.threshold_number.value === '' ? -1 : Math.max(0, Number(this.threshold_number.value)); }
    get range(): [number, number] {
        const [lo, hi] = this.chosen ?? this.limits;
        return [this.log.checked ? above_zero(lo, hi) : lo, hi];
    }

    /** Steps of the colours for values in a range, and the handles where they belong. */
    steps(values: [number, number]): number[] {
        this.limits = values[1] > 0 ? values : [0, 1];
        // The track does not depend on the handles, which would run away from the pointer.
        const round = round_steps(...this.limits, this.log.checked);
        this.limits = [round[0], round[round.length - 1]];
        const [lo, hi] = this.range, steps = this.chosen ? steps_within(lo, hi, this.log.checked) : round;
        this.show();
        return steps;
    }

    private ends(): [number, number] {
        const [lo, hi] = this.limits, top = Math.max(1.2 * hi, this.range[1]);
        return this.log.checked ? [above_zero(Math.min(lo, this.range[0]), top), top] : [0, top];
    }

    /** Four digits: with three, steps of the keyboard would be rounded back to where the handle is. */
    private value(position: number): number {
        const [lo, hi] = this.ends(), t = position / track;
        return Number((this.log.checked ? lo * (hi / lo) ** t : lo + (hi - lo) * t).toPrecision(4));
    }

    private position(value: number): number {
        const [lo, hi] = this.ends();
        return Math.round(track * (this.log.checked ? Math.log(Math.max(value, lo) / lo) / Math.log(hi / lo) : (value - lo) / (hi - lo)));
    }

    private drag(handle: HTMLInputElement): void {
        // Handles keep apart by a hundredth of the track.
        const gap = track / 100;
        if (handle === this.lo) this.lo.value = String(Math.min(Number(this.lo.value), Number(this.hi.value) - gap));
        else this.hi.value = String(Math.max(Number(this.hi.value), Number(this.lo.value) + gap));
        this.chosen = [this.value(Number(this.lo.value)), this.value(Number(this.hi.value))];
        this.changed();
    }

    private type(): void {
        const lo = Number(this.lo_number.value), hi = Number(this.hi_number.value);
        if (hi > lo && lo >= 0) this.chosen = [lo, hi];
        this.changed();
    }

    private show(): void {
        const [lo, hi] = this.range, a = this.position(lo), b = this.position(hi);
        this.lo.value = String(a), this.hi.value = String(b);
        this.lo.setAttribute('aria-valuetext', short(lo)), this.hi.setAttribute('aria-valuetext', short(hi));
        if (document.activeElement !== this.lo_number) this.lo_number.value = String(Number(lo.toPrecision(4)));
        if (document.activeElement !== this.hi_number) this.hi_number.value = String(Number(hi.toPrecision(4)));
        by_id('scale').style.setProperty('--from', `${100 * a / track}%`);
        by_id('scale').style.setProperty('--to', `${100 * b / track}%`);
    }
}
