// Keeps what takes time to make, by keys. Once it has `most`, it forgets all, and what is still used is made again.

class Cache {
    constructor(most) {
        this.most = most;
        this.made = new Map();
    }

    get(key, make) {
        let own = this.made.get(key);
        if (own === undefined) {
            if (this.made.size >= this.most) this.made.clear();
            own = make();
            this.made.set(key, own);
        }
        return own;
    }
}
