# Growth of the total energy of the unstabilised bar of this folder under TVD-RK2: each mode of the
# discrete bar grows by 1 + (w dt)^4 / 4 a step, Upwind (4.1). Needs numpy; prints start energy,
# number of steps and growth.
import numpy as np
n=40; L=10.; kappa=1e6; rho=1000.; dt=5e-4
dx=L/(n-1); X=np.arange(n)*dx; h=dx
def dW(r):
    q=abs(r)/h
    f=np.where(q<1,-2*q+1.5*q*q,np.where(q<2,-0.5*(2-q)**2,0))/h/h
    return f*np.sign(r)
d=X[:,None]-X[None,:]           # X_a - X_b
g=dx*dW(d)                      # w grad_a W_ab
M=(g*(-d)).sum(1); G=g/M[:,None]
np.fill_diagonal(G,0); np.fill_diagonal(G,-G.sum(1))
V=np.full(n,dx); V[0]=V[-1]=dx/2
# rho V v' = -kappa V-weighted G^T (J-1):  v'_a = -(kappa/(rho V_a)) sum_b V_b G_ba e_b ; e' = G v ; v_0=0
free=np.arange(1,n)
m=rho*V[free]
B=(np.sqrt(kappa*V)[:,None]*G[:,free])/np.sqrt(m)[None,:]   # scaled: e~'=B v~, v~'=-B^T e~
U,s,Vt=np.linalg.svd(B,full_matrices=False)
v0=np.where(X>5,2.,0.)[free]*np.sqrt(m)
a=Vt@v0; E=0.5*a*a
steps=int(np.ceil(1.2649110640673518/dt-1e-9))
print(E.sum(),steps,(E*(1+(s*dt)**4/4)**steps).sum()/E.sum()-1)
